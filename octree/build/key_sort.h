#pragma once
/// The sort behind the octree: keys of a space-filling curve, on all cores.
#include "octree/pool.h"
#include <cstdint>

namespace pointgi {

struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by key. Items must come in ascending order of their index, and items of equal keys keep it, so that coincident
/// points have one order on every machine. Radix sort of the highest 33 bits that differ, which tell nearly all points
/// of a surface apart; what still ties is put right by comparing. The same result for any number of threads.
void sort_by_key(Pool<KeyedIndex>& items);

} // namespace pointgi
