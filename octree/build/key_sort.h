#pragma once
/// The sort behind the octree: keys of a space-filling curve, on all cores.
#include "octree/pool.h"
#include <cstdint>
#include <vector>

namespace pointgi {

struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by key. Items must come in ascending order of their index, and items of equal keys keep it, so that coincident
/// points have one order on every machine. Radix sort of the highest 33 bits that differ, which tell nearly all points
/// of a surface apart; what still ties is put right by comparing. Items that are sorted are only looked at. The same
/// result for any number of threads.
void sort_by_key(Pool<KeyedIndex>& items);

/// Borders of ranges of about `grain` items, from 0 to n, that no items of equal keys lie across. key(i) is that of the
/// i-th item in their order.
template <class Key>
std::vector<std::size_t> cuts_between_keys(std::size_t n, std::size_t grain, const Key& key) {
  std::vector<std::size_t> cuts{0};
  while (cuts.back() < n) {
    std::size_t at = cuts.back() + grain < n ? cuts.back() + grain : n;
    while (at < n && key(at) == key(at - 1))
      ++at;
    cuts.push_back(at);
  }
  return cuts;
}

} // namespace pointgi
