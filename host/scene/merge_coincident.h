#pragma once
#include "octree/splat.h"
#include <cstdint>
#include <vector>

namespace pointgi {

/// A splat that went, and the one that stands for it now, by their ids.
struct MergedSplat {
  std::uint32_t id, into;
};

/// Two splats that stay, in one place, of one material, facing opposite ways: the sides of a sheet. Indices.
struct CoincidentSides {
  std::uint32_t one, other;
};

/// Splats at one place of the root cube (bit-identical), of one material and facing alike (within 60 degrees), become
/// one: the sum of their areas, the largest radius, mean colour and normal. A hundred thousand points in one place
/// would otherwise be tested one by one by every ray that comes near. `id[i]` goes with splat i; the first one's is
/// kept. Returns the splats that went. `sides`, if not null, receives the pairs that are left, by their new indices,
/// ascending. `alone`: of each id, whether it stays by itself, as the faces at a mesh's edge do, which end there;
/// beyond sixteen in one place they are merged, too. Empty: none is. O(n log n).
std::vector<MergedSplat> merge_coincident(std::vector<Splat>& splats, std::vector<std::uint32_t>& id,
                                          std::vector<CoincidentSides>* sides = nullptr,
                                          const std::vector<bool>& alone = {});

} // namespace pointgi
