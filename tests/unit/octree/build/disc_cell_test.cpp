#include "octree/build/disc_cell.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

bool touches(const Splat& s, const Cell& cell) {
  float half[3];
  disc_half_extents(s, half);
  return disc_touches_cell(s, half, cell);
}

} // namespace

TEST_CASE("a disc touches the cells that its points lie in") {
  // Whatever the disc: a point drawn on it lies in a cell that the test must not miss.
  std::mt19937 g(5);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const Splat& s : random_splats(400, 2)) {
    const float* n = s.normal;
    const float sign = std::copysign(1.0f, n[2]), a = -1.0f / (sign + n[2]), b = n[0] * n[1] * a;
    const float u[3] = {1.0f + sign * n[0] * n[0] * a, sign * b, -sign * n[0]},
                v[3] = {b, sign + n[1] * n[1] * a, -n[1]};
    for (int k = 0; k < 50; ++k) {
      const float r = s.radius * std::sqrt(unit(g)), phi = 6.2831853f * unit(g), side = 1.0f / 32.0f;
      Cell cell{{}, side};
      for (int c = 0; c < 3; ++c)
        cell.low[c] = side * std::floor((s.position[c] + r * (std::cos(phi) * u[c] + std::sin(phi) * v[c])) / side);
      REQUIRE(touches(s, cell));
    }
  }
}

TEST_CASE("cells beside, above and diagonally off a disc are not touched") {
  const Splat flat = make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f);
  CHECK(touches(flat, {{0.55f, 0.45f, 0.45f}, 0.1f}));
  CHECK_FALSE(touches(flat, {{0.65f, 0.45f, 0.45f}, 0.1f})); // beside
  CHECK_FALSE(touches(flat, {{0.45f, 0.45f, 0.51f}, 0.1f})); // above its plane
  const Splat tilted = make_splat(0.5f, 0.5f, 0.5f, 1, 1, 0, 0.1f);
  CHECK(touches(tilted, {{0.52f, 0.43f, 0.5f}, 0.05f}));
  CHECK_FALSE(touches(tilted, {{0.53f, 0.53f, 0.5f}, 0.04f})); // inside its bounding box, off its plane
}

TEST_CASE("a disc nearly parallel to an axis plane keeps its extent") {
  // 1 - n² of a float normal loses everything below 3e-4; the two other components do not.
  const Splat s = make_splat(0.5f, 0.5f, 0.5f, 1e-4f, 0, 1, 0.1f);
  float half[3];
  disc_half_extents(s, half);
  CHECK(half[2] == Approx(1e-5).epsilon(1e-5));
  CHECK(half[0] == Approx(0.1).epsilon(1e-5));
}
