#pragma once
/// What `render` and `info` share on the way from a file to the octree's pools.
#include "host/scene/load_scene.h"
#include "host/scene/splats.h"
#include "octree/pack/step_pools.h"

namespace pointgi {

/// Whether the name is a scene file's (.toml) and not a cloud's.
bool is_scene_file(const std::string& file);

/// log2 N of the settings' tree.
unsigned axis_bits_of(const OctreeSettings& settings);

/// Builds and packs the tree. Debug builds verify the pools.
StepPools build_pools(const std::vector<Splat>& splats, const OctreeSettings& settings);

/// Throws Error(input) naming the first material that this version cannot render: never drawn wrong.
void refuse_unsupported(const Scene& scene);

} // namespace pointgi
