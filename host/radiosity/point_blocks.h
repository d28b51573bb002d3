#pragma once
/// Points in blocks that look much the same way, for rays that are traced together.
#include "octree/splat.h"
#include "octree/view.h"
#include <cstdint>
#include <vector>

namespace pointgi {

/// `places` of `points` in another order: each `size` > 0 that follow each other lie close together and face about the
/// same way; fewer in the last block. Within a block they ascend. O(n log n).
std::vector<std::uint32_t> in_blocks(View<Splat> points, std::vector<std::uint32_t> places, std::size_t size);

} // namespace pointgi
