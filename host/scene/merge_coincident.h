#pragma once
#include "octree/splat.h"
#include <vector>

namespace pointgi {

/// Splats at one place of the root cube (bit-identical), of one material and facing alike (within 60 degrees), become
/// one: the sum of their areas, the largest radius, mean colour and normal. A hundred thousand points in one place
/// would otherwise be tested one by one by every ray that comes near. `id[i]` goes with splat i; the first one's is
/// kept. Returns how many splats went. O(n log n).
std::size_t merge_coincident(std::vector<Splat>& splats, std::vector<std::uint32_t>& id);

} // namespace pointgi
