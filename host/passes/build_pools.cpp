#include "host/passes/build_pools.h"
#include "octree/build/cell_key.h"
#include <algorithm>

namespace pointgi {

OctreePools build_pools(const std::vector<Splat>& splats, const TraversalVariant& variant, const SplatClips& clips,
                        const PatchBends& bends) {
  const bool wide = variant.form == TraversalForm::wide;
  TreeOptions options;
  options.axis_bits = variant.axis_bits;
  options.leaf_capacity = variant.leaf_capacity;
  options.max_depth = std::min(variant.max_depth, key_levels(variant.axis_bits));
  options.order = variant.order;
  options.listing = wide ? Listing::centres : Listing::overlaps;
  const Tree tree = build_tree(splats, options, bends);
  OctreePools pools = wide ? OctreePools(pack_wide(splats, tree, variant.lanes, clips, bends))
                           : OctreePools(pack_step(splats, tree, clips, bends));
#ifndef NDEBUG
  std::visit([](const auto& p) { verify(p); }, pools);
#endif
  return pools;
}

} // namespace pointgi
