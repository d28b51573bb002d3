#include "octree/ref/closest_hit.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("the linear scan meets discs where geometry says") {
  const std::vector<Splat> splats = {make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f),
                                     make_splat(0.5f, 0.5f, 0.7f, 0, 0, 1, 0.1f)};
  const double down[3] = {0, 0, -1}, along[3] = {1, 0, 0};
  const double above[3] = {0.55, 0.5, 1.0}, rim[3] = {0.5999, 0.5, 1.0}, past[3] = {0.6001, 0.5, 1.0};
  CHECK(closest_hit(splats, above, down, 0, 8).splat == 1);
  CHECK(closest_hit(splats, above, down, 0, 8).t == Approx(0.3));
  CHECK(closest_hit(splats, above, down, 0.3001, 8).splat == 0); // t_min skips the first
  CHECK(closest_hit(splats, above, down, 0, 0.2).splat == RayHit::none);
  CHECK(closest_hit(splats, rim, down, 0, 8).splat == 1);
  CHECK(closest_hit(splats, past, down, 0, 8).splat == RayHit::none);
  const double level[3] = {0.0, 0.5, 0.5};
  CHECK(closest_hit(splats, level, along, 0, 8).splat == RayHit::none); // in the plane: edge-on discs are not met
}
