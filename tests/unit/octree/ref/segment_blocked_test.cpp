#include "octree/ref/closest_hit.h"
#include "octree/ref/segment_blocked.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("a disc between two points blocks, one beside them does not") {
  const Splat from = make_splat(0.5f, 0.5f, 0.1f, 0, 0, 1, 0.01f), to = make_splat(0.5f, 0.5f, 0.9f, 0, 0, -1, 0.01f);
  std::vector<Splat> splats{from, to};
  CHECK_FALSE(segment_blocked(splats, from, to));
  splats.push_back(make_splat(0.52f, 0.5f, 0.5f, 1, 0, 2, 0.01f));
  CHECK_FALSE(segment_blocked(splats, from, to));
  splats[2].radius = 0.03f;
  CHECK(segment_blocked(splats, from, to));
  splats[2].position[2] = 0.95f; // behind the end
  CHECK_FALSE(segment_blocked(splats, from, to));
}

TEST_CASE("the surfaces at a segment's ends do not block it, a wall at an end does") {
  const Splat from = make_splat(0.5f, 0.5f, 0.1f, 0, 0, 1, 0.01f), to = make_splat(0.5f, 0.6f, 0.9f, 0, 0, -1, 0.01f);
  std::vector<Splat> splats{from, to, make_splat(0.505f, 0.5f, 0.105f, 0.3f, 0, 1, 0.02f)}; // a neighbour's rim
  CHECK_FALSE(segment_blocked(splats, from, to));
  CHECK_FALSE(segment_blocked(splats, to, from));
  splats[2] = make_splat(0.505f, 0.5f, 0.105f, 0.3f, 0, -1, 0.02f); // the same place, facing the other way
  CHECK(segment_blocked(splats, from, to));
  CHECK(segment_blocked(splats, to, from));
}

TEST_CASE("far from the ends a segment is blocked where the nearest hit of its ray lies between them") {
  const auto splats = random_splats(300, 23);
  std::size_t blocked = 0, counted = 0;
  for (std::size_t i = 0; i < splats.size(); ++i)
    for (std::size_t j = i + 1; j < splats.size(); j += 7) {
      // Points without surface: no hit belongs to them.
      Splat from = splats[i], to = splats[j];
      from.radius = to.radius = 0.0f;
      for (int a = 0; a < 3; ++a)
        from.normal[a] = to.normal[a] = 0.0f;
      double origin[3], direction[3];
      for (int a = 0; a < 3; ++a) {
        origin[a] = from.position[a];
        direction[a] = static_cast<double>(to.position[a]) - origin[a];
      }
      const double length = std::hypot(direction[0], direction[1], direction[2]);
      for (double& d : direction)
        d /= length;
      std::vector<Splat> others = splats;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const bool truth = closest_hit(others, origin, direction, 0.0, length).splat != RayHit::none;
      REQUIRE(segment_blocked(others, from, to) == truth);
      blocked += truth;
      ++counted;
    }
  CHECK(blocked > counted / 10);
  CHECK(blocked < counted);
}
