/// Cones of a point, and the cube that voxels divide.
#include "host/radiosity/cones.h"
#include "host/scene/limits.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

double half_angle(const Cone& cone) {
  return std::atan(0.5 * cone.spread);
}

} // namespace

TEST_CASE("cones of every set are a quadrature of cosine-weighted light, and cover the hemisphere") {
  for (const int count : limits::cone_counts) {
    CAPTURE(count);
    const std::vector<Cone> cones = cone_set(static_cast<unsigned>(count));
    REQUIRE(cones.size() == static_cast<std::size_t>(count));
    // Means of powers of u = sine squared over cosine-weighted directions, which are even in u, are 1/(k + 1): exact up
    // to 2 nodes - 1 of Gauss, 2 nodes - 2 of Radau. Aside all cancels.
    const int exact = count == 1 ? 0 : count == 6 ? 2 : count == 9 ? 3 : 4;
    double power[5] = {}, aside[2] = {}, across = 0.0;
    for (const Cone& cone : cones) {
      const double x = cone.axis[0], y = cone.axis[1], z = cone.axis[2];
      CHECK(x * x + y * y + z * z == Approx(1.0).epsilon(1e-6));
      CHECK(z > 0.35);
      CHECK(cone.spread > 0.0f);
      for (int k = 0; k <= exact; ++k)
        power[k] += cone.share * std::pow(1.0 - z * z, k);
      aside[0] += cone.share * x;
      aside[1] += cone.share * y;
      across += cone.share * (x * x - y * y);
    }
    for (int k = 0; k <= exact; ++k)
      CHECK(power[k] == Approx(1.0 / (k + 1.0)).epsilon(1e-5));
    CHECK(std::fabs(aside[0]) + std::fabs(aside[1]) + std::fabs(across) < 1e-5);
    // A cone has the solid angle of its part of a ring, which is not round: no direction is farther outside than 0.7 of
    // the cone's half angle, and few are outside at all. One cone leaves out what is flatter than 30 degrees.
    if (count == 1) continue;
    std::mt19937 g(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int outside = 0;
    double farthest = 0.0;
    for (int k = 0; k < 2000; ++k) { // by the cosine
      const double s = std::sqrt(unit(g)), angle = 6.283185307179586 * unit(g);
      const double d[3] = {s * std::cos(angle), s * std::sin(angle), std::sqrt(1.0 - s * s)};
      double nearest = 1e9;
      for (const Cone& cone : cones)
        nearest = std::min(
            nearest, std::acos(std::min(1.0, d[0] * cone.axis[0] + d[1] * cone.axis[1] + double{d[2]} * cone.axis[2])) /
                         half_angle(cone));
      farthest = std::max(farthest, nearest);
      outside += nearest > 1.0;
    }
    CHECK(farthest < 1.7);
    CHECK(outside < 0.25 * 2000);
  }
  for (const unsigned count : {0u, 2u, 7u, 256u})
    CHECK_THROWS_AS(cone_set(count), std::invalid_argument);
}

TEST_CASE("the cube of voxels holds every disc with a voxel and a half to spare") {
  const std::vector<Splat> splats = random_splats(300, 4);
  for (const int side : limits::voxel_sides) {
    CAPTURE(side);
    const ConeGrid grid = cone_grid(splats, static_cast<unsigned>(side));
    CHECK(1 << grid.side_log2 == side);
    CHECK(CONE_GRID_LEVELS(&grid) <= CONE_MOST_LEVELS);
    double least = 1e9, most = -1e9;
    for (const Splat& s : splats)
      for (int a = 0; a < 3; ++a) {
        const double reach = s.radius * std::sqrt(std::max(0.0, 1.0 - double{s.normal[a]} * s.normal[a]));
        least = std::min(least, (s.position[a] - reach - grid.origin[a]) / grid.voxel);
        most = std::max(most, (s.position[a] + reach - grid.origin[a]) / grid.voxel);
      }
    CHECK(least >= 1.499); // rounding to float
    CHECK(most <= side - 1.499);
    CHECK(most >= side - 1.5 - 0.1 * side); // it is no larger than needed: the widest axis decides
    pg_uint first = 0;
    for (pg_uint level = 0; level < CONE_GRID_LEVELS(&grid); ++level) {
      const pg_uint row = (static_cast<pg_uint>(side) >> level) + 2u;
      CHECK(grid.first[level] == first);
      first += row * row * row;
    }
  }
  for (const unsigned side : {0u, 4u, 48u, 512u})
    CHECK_THROWS_AS(cone_grid(splats, side), std::invalid_argument);
  CHECK_THROWS_AS(cone_grid({}, 64), std::invalid_argument);
}
