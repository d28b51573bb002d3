#include "octree/build/cell_key.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace pointgi;

TEST_CASE("cells are int(p * 2^21), clamped into the cube") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inside[3] = {0.0f, 0.5f, std::nextafter(1.0f, 0.0f)}, outside[3] = {-1.0f, 1.0f, nan};
  CHECK(cell_of(inside) == CellCoordinates{0u, 1u << 20, (1u << 21) - 1u});
  CHECK(cell_of(outside) == CellCoordinates{0u, (1u << 21) - 1u, 0u});
}

TEST_CASE("for N = 2 the key is Morton's interleaving, x lowest") {
  CHECK(cell_key({1, 0, 0}, 1) == 1u);
  CHECK(cell_key({0, 1, 0}, 1) == 2u);
  CHECK(cell_key({0, 0, 1}, 1) == 4u);
  CHECK(cell_key({3, 0, 2}, 1) == (1u | 8u | 32u));
  const std::uint32_t top = 1u << 20;
  CHECK(cell_key({top, top, top}, 1) == (7ull << 60));
}

TEST_CASE("for N = 4 each digit is x + 4y + 16z") {
  // 21 bits are ten digits of two and the lowest bit over.
  CHECK(cell_key({1, 1, 1}, 2) == 0u);
  CHECK(cell_key({2 * 3, 2 * 1, 2 * 2}, 2) == 3u + 4u * 1u + 16u * 2u);
  CHECK(cell_key({(1u << 21) - 1u, 0, 0}, 2) >> 54 == 3u);
}
