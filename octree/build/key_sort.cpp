#include "octree/build/key_sort.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

namespace pointgi {

namespace {

constexpr unsigned digit_bits = 11, passes = 3;
constexpr std::size_t digits = std::size_t{1} << digit_bits;
constexpr std::size_t few = 4096; // fewer are compared: counting 2048 digits takes longer

bool before(const KeyedIndex& a, const KeyedIndex& b) {
  return a.key != b.key ? a.key < b.key : a.index < b.index;
}

class Sorter {
public:
  /// Sorts items[0, n) by way of scratch[0, n), and returns where of the two the result lies.
  static KeyedIndex* sort(KeyedIndex* items, KeyedIndex* scratch, std::size_t n) {
    if (n > few) return Sorter(items, scratch, n).run();
    std::sort(items, items + n, before);
    return items;
  }

private:
  Sorter(KeyedIndex* items, KeyedIndex* scratch, std::size_t n)
      : items_(items), scratch_(scratch), n_(n), grain_(std::max(few, (n + 31) / 32)) {}

  KeyedIndex* run() {
    const unsigned bits = differing_bits();
    if (bits == 0) return items_;
    shift_ = bits > passes * digit_bits ? bits - passes * digit_bits : 0;
    for (unsigned pass = 0; pass < passes; ++pass) {
      scatter(shift_ + pass * digit_bits);
      std::swap(items_, scratch_);
    }
    if (shift_ > 0) sort_ties();
    return items_;
  }

  /// 1 + the highest bit in which any two keys differ; 0 if all are equal.
  unsigned differing_bits() const {
    std::vector<std::uint64_t> found((n_ + grain_ - 1) / grain_);
    parallel_ranges(n_, grain_, [&](std::size_t begin, std::size_t end) {
      std::uint64_t differing = 0;
      for (std::size_t i = begin; i < end; ++i)
        differing |= items_[i].key ^ items_[0].key;
      found[begin / grain_] = differing;
    });
    std::uint64_t all = 0;
    for (const std::uint64_t differing : found)
      all |= differing;
    unsigned bits = 0;
    for (; all != 0; all >>= 1)
      ++bits;
    return bits;
  }

  /// One stable pass: where a range's items of a digit go follows from what all ranges hold of smaller digits, and the
  /// ranges before it of this one.
  void scatter(unsigned shift) {
    std::vector<std::array<std::uint32_t, digits>> next((n_ + grain_ - 1) / grain_);
    const auto digit = [&](const KeyedIndex& item) { return (item.key >> shift) & (digits - 1); };
    parallel_ranges(n_, grain_, [&](std::size_t begin, std::size_t end) {
      auto& count = next[begin / grain_];
      for (std::size_t i = begin; i < end; ++i)
        ++count[digit(items_[i])];
    });
    std::uint32_t at = 0;
    for (std::size_t d = 0; d < digits; ++d)
      for (auto& count : next) {
        const std::uint32_t here = count[d];
        count[d] = at;
        at += here;
      }
    parallel_ranges(n_, grain_, [&](std::size_t begin, std::size_t end) {
      auto& to = next[begin / grain_];
      for (std::size_t i = begin; i < end; ++i)
        scratch_[to[digit(items_[i])]++] = items_[i];
    });
  }

  /// Sorts each run of items that the passes could not tell apart.
  void sort_ties() {
    const auto prefix = [&](std::size_t i) { return items_[i].key >> shift_; };
    // Cut where no run is cut, so that each range sorts its own.
    std::vector<std::size_t> cuts{0};
    while (cuts.back() < n_) {
      const std::size_t last = std::min(cuts.back() + grain_, n_) - 1;
      const auto past = std::partition_point(
          items_ + last, items_ + n_, [&](const KeyedIndex& item) { return item.key >> shift_ == prefix(last); });
      cuts.push_back(static_cast<std::size_t>(past - items_));
    }
    std::vector<std::pair<std::size_t, std::size_t>> long_runs(cuts.size());
    parallel_ranges(cuts.size() - 1, 1, [&](std::size_t range, std::size_t) {
      for (std::size_t begin = cuts[range], end; begin < cuts[range + 1]; begin = end) {
        for (end = begin + 1; end < cuts[range + 1] && prefix(end) == prefix(begin); ++end) {
        }
        if (end - begin > grain_)
          long_runs[range] = {begin, end}; // only one fits: a range is cut at the first run's end past the grain
        else if (!std::is_sorted(items_ + begin, items_ + end, before))
          std::sort(items_ + begin, items_ + end, before);
      }
    });
    for (const auto& [begin, end] : long_runs) {
      const KeyedIndex* sorted = sort(items_ + begin, scratch_ + begin, end - begin);
      if (sorted != items_ + begin) std::copy(sorted, sorted + (end - begin), items_ + begin);
    }
  }

  KeyedIndex* items_;
  KeyedIndex* scratch_;
  std::size_t n_, grain_;
  unsigned shift_ = 0;
};

bool is_sorted(const Pool<KeyedIndex>& items) {
  std::atomic<bool> sorted{true};
  parallel_ranges(items.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
    const auto past = items.begin() + static_cast<std::ptrdiff_t>(std::min(end + 1, items.size()));
    if (sorted && !std::is_sorted(items.begin() + static_cast<std::ptrdiff_t>(begin), past, before)) sorted = false;
  });
  return sorted;
}

} // namespace

void sort_by_key(Pool<KeyedIndex>& items) {
  if (is_sorted(items)) return;
  Pool<KeyedIndex> scratch(items.size() > few ? items.size() : 0);
  if (Sorter::sort(items.data(), scratch.data(), items.size()) != items.data()) items.swap(scratch);
}

} // namespace pointgi
