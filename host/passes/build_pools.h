#pragma once
#include "host/passes/variant.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// Builds the tree and packs it in the variant's form. Programs of a variant whose `clips` or `patches` is set go with
/// pools that have clips or bends. Debug builds verify the pools.
OctreePools build_pools(const std::vector<Splat>& splats, const TraversalVariant& variant, const SplatClips& clips = {},
                        const PatchBends& bends = {});

} // namespace pointgi
