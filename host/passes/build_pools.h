#pragma once
#include "host/passes/variant.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// Builds the tree and packs it in the variant's form. Debug builds verify the pools.
OctreePools build_pools(const std::vector<Splat>& splats, const TraversalVariant& variant);

} // namespace pointgi
