#pragma once
/// What `render` and `info` share on the way from a file to the octree's pools.
#include "host/passes/variant.h"
#include "host/scene/load_scene.h"
#include "host/scene/splats.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// Whether the name is a scene file's (.toml) and not a cloud's.
bool is_scene_file(const std::string& file);

/// Builds the tree and packs it in the variant's form. Debug builds verify the pools.
OctreePools build_pools(const std::vector<Splat>& splats, const OctreeSettings& settings,
                        const TraversalVariant& variant);

/// Throws Error(input) naming the first material that this version cannot render: never drawn wrong.
void refuse_unsupported(const Scene& scene);

} // namespace pointgi
