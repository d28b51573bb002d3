#include "octree/build/curve.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;

namespace {

/// The cells of the full grid of 2^level cells a side, by their keys along the curve.
std::vector<CellCoordinates> walk(const Curve& curve, unsigned level) {
  const unsigned shift = MAX_AXIS_BITS - level, side = 1u << level;
  std::vector<CellCoordinates> cells;
  for (std::uint32_t i = 0; i < side * side * side; ++i)
    cells.push_back({i % side, i / side % side, i / side / side});
  const auto key = [&](const CellCoordinates& c) { return curve.key({c[0] << shift, c[1] << shift, c[2] << shift}); };
  std::sort(cells.begin(), cells.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return cells;
}

} // namespace

TEST_CASE("consecutive cells of Hilbert's order have a common face") {
  const unsigned level = GENERATE(1u, 2u, 3u, 4u);
  const auto cells = walk(Curve(PointOrder::hilbert, 1), level);
  std::size_t apart = 0;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    int steps = 0;
    for (int a = 0; a < 3; ++a)
      steps += std::abs(static_cast<int>(cells[i][a]) - static_cast<int>(cells[i - 1][a]));
    apart += steps != 1;
  }
  CHECK(apart == 0);
}

TEST_CASE("a curve's key is the way down its places, and its children are all eight") {
  const auto order = GENERATE(PointOrder::morton, PointOrder::hilbert);
  const Curve curve(order, 1);
  std::mt19937 g(5);
  std::uniform_int_distribution<std::uint32_t> at(0, (1u << MAX_AXIS_BITS) - 1u);
  for (int k = 0; k < 1000; ++k) {
    const CellCoordinates cell{at(g), at(g), at(g)};
    const std::uint64_t children = cell_key(cell, 1), places = curve.key(cell);
    unsigned state = Curve::start;
    for (unsigned level = key_levels(1); level-- > 0;) {
      const auto place = static_cast<unsigned>(places >> (3 * level)) & 7u;
      REQUIRE(curve.child(state, place) == (static_cast<unsigned>(children >> (3 * level)) & 7u));
      unsigned met = 0;
      for (unsigned p = 0; p < 8; ++p)
        met |= 1u << curve.child(state, p);
      REQUIRE(met == 255u);
      state = curve.next(state, place);
    }
  }
}

TEST_CASE("Morton's key without the loop is the key digit by digit") {
  std::mt19937 g(7);
  std::uniform_int_distribution<std::uint32_t> at(0, (1u << MAX_AXIS_BITS) - 1u);
  for (int k = 0; k < 1000; ++k) {
    const CellCoordinates cell{at(g), at(g), at(g)};
    REQUIRE(morton_key(cell) == cell_key(cell, 1));
    REQUIRE(Curve(PointOrder::morton, 2).key(cell) == cell_key(cell, 2));
  }
}

TEST_CASE("Hilbert's order is refused for N = 4") {
  CHECK_THROWS_AS(Curve(PointOrder::hilbert, 2), std::invalid_argument);
}
