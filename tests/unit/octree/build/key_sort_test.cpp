#include "octree/build/key_sort.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;

namespace {

/// Whether the sort agrees with the library's.
bool sorts(const std::vector<std::uint64_t>& keys) {
  Pool<KeyedIndex> items;
  for (std::size_t i = 0; i < keys.size(); ++i)
    items.push_back({keys[i], static_cast<std::uint32_t>(i)});
  Pool<KeyedIndex> truth = items;
  std::stable_sort(truth.begin(), truth.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  sort_by_key(items);
  return std::equal(items.begin(), items.end(), truth.begin(), truth.end(),
                    [](const auto& a, const auto& b) { return a.key == b.key && a.index == b.index; });
}

} // namespace

TEST_CASE("keys are sorted as a stable comparison sort sorts them") {
  std::mt19937_64 g(3);
  // Below and above where digits are counted, and in one range and in several.
  const std::size_t count = GENERATE(0u, 1u, 2u, 1000u, 4096u, 4097u, 30'000u, 300'000u);
  CAPTURE(count);
  std::vector<std::uint64_t> keys(count);
  SECTION("anywhere") {
    for (auto& key : keys)
      key = g() >> 1;
  }
  SECTION("all equal") {
    std::fill(keys.begin(), keys.end(), std::uint64_t{12345} << 40);
  }
  SECTION("many of few") {
    for (auto& key : keys)
      key = (g() % 7) * 0x0123456789abcdefu;
  }
  SECTION("in the lowest bits alone") {
    for (auto& key : keys)
      key = g() % 1000;
  }
  SECTION("a dense dot and a few far away: more ties in the highest bits than a range holds") {
    for (auto& key : keys)
      key = g() % 1000 == 0 ? g() >> 1 : (std::uint64_t{5} << 60) + (g() >> 35);
  }
  SECTION("descending") {
    for (std::size_t i = 0; i < count; ++i)
      keys[i] = (count - i) << 30;
  }
  CHECK(sorts(keys));
}

TEST_CASE("cuts lie between different keys, and ranges are about as long as asked for") {
  std::mt19937_64 g(4);
  Pool<KeyedIndex> items;
  std::uint64_t key = 0;
  while (items.size() < 50'000) {
    const std::size_t run = g() % 100 == 0 ? 3000 : 1 + g() % 3;
    for (std::size_t k = 0; k < run; ++k)
      items.push_back({key, static_cast<std::uint32_t>(items.size())});
    key += 1 + g() % 5;
  }
  const auto cuts = cuts_between_keys(items.size(), 1000, [&](std::size_t i) { return items[i].key; });
  CHECK(cuts.front() == 0);
  CHECK(cuts.back() == items.size());
  for (std::size_t c = 1; c < cuts.size(); ++c) {
    CHECK(cuts[c] > cuts[c - 1]);
    CHECK(cuts[c] - cuts[c - 1] < 1000 + 3000);
    if (cuts[c] < items.size()) CHECK(items[cuts[c]].key != items[cuts[c] - 1].key);
  }
  CHECK(cuts_between_keys(0, 1000, [](std::size_t) { return 0; }) == std::vector<std::size_t>{0});
}
