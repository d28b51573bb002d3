/// What the planner knows of a scene before its visibility is asked for.
#include "host/radiosity/plan.h"
#include "octree/parallel.h"
#include "octree/ref/segment_blocked.h"
#include "tests/support/exchange.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>
#include <limits>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

double bound(const std::vector<Splat>& splats, double albedo, double enough = 1e30) {
  const ClusterTree tree = build_clusters(splats, {});
  return bound_of_exchange(tree, std::vector<float>(3 * splats.size(), static_cast<float>(albedo)), albedo, enough);
}

/// How many questions there were.
class CountedScan : public VisibilityOracle {
public:
  CountedScan(View<Splat> points, View<Splat> splats) : scan_(points, splats) {}
  std::vector<std::uint8_t> blocked(View<Segment> segments) override {
    asked += segments.size;
    return scan_.blocked(segments);
  }
  std::size_t asked = 0;

private:
  LinearScan scan_;
};

} // namespace

TEST_CASE("the bound of light between surfaces: nothing of a ball, all of a room, what two sheets send each other") {
  for (const std::size_t points : {3000u, 30000u})
    CHECK(bound(sphere_splats(points, 0.3f), 0.5) < 1e-5); // rounding of its discs' normals
  // A room: all that leaves arrives, half is sent again, half of it: 0.5 + 0.25 + ... = 1. The bound is above it.
  const double room = bound(inside_cube(20), 0.5);
  CHECK(room > 0.99);
  // A plane whose normals are noisy: all pairs of its clusters may face each other, and it is not told in time.
  std::vector<Splat> plane;
  add_quad(plane, 150, {0.1, 0.1, 0.5}, {0.8, 0.0, 0.0}, {0.0, 0.8, 0.0}, {0.0, 0.0, 1.0}, 0.64);
  std::mt19937 g(1);
  std::normal_distribution<float> noise(0.0f, 0.02f);
  for (Splat& s : plane) {
    s.normal[0] = noise(g);
    s.normal[1] = noise(g);
    s.normal[2] = std::sqrt(1.0f - s.normal[0] * s.normal[0] - s.normal[1] * s.normal[1]);
  }
  CHECK(bound(plane, 0.5) == std::numeric_limits<double>::infinity());
  // A run that is to end does not wait for it.
  const ClusterTree tree = build_clusters(plane, {});
  const std::vector<float> radiosity(3 * plane.size(), 0.5f);
  before_ranges([] { throw std::runtime_error("enough"); });
  CHECK_THROWS_WITH(bound_of_exchange(tree, radiosity, 0.5, 1e30), "enough");
  before_ranges(nullptr);
  // Unit squares 1 apart: form factor 0.199825 (truths.md), and 0.5 + 0.25 + ... = 1 times it at most.
  std::vector<Splat> sheets;
  add_quad(sheets, 30, {0.1, 0.1, 0.2}, {0.5, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0}, 0.25);
  add_quad(sheets, 30, {0.1, 0.1, 0.7}, {0.5, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, -1.0}, 0.25);
  const double between = bound(sheets, 0.5);
  CHECK(between > 0.199825 * 0.999);
  CHECK(between < 1.5);
  CHECK(bound(sheets, 0.5, 0.01) >= 0.01); // more than enough is known
  CHECK(bound({}, 0.5) == 0.0);
}

TEST_CASE("a sample of the V-map's questions tells how many there will be, and asks few of them", "[long]") {
  const ClusterTree tree = build_clusters(room_splats(1500), {});
  LinkOptions options;
  options.epsilon = 2e-3f; // many links of few points
  CountedScan all(tree.points, tree.points), some(tree.points, tree.points);
  const VMap map = make_links(tree, all, options);
  const LinkEstimate estimate = estimate_links(tree, some, options, {}, 200);
  CAPTURE(map.statistics.rays, estimate.rays, map.links.size(), estimate.links, all.asked, some.asked);
  CHECK(some.asked < all.asked / 3);
  CHECK(estimate.links == Approx(static_cast<double>(map.links.size())).epsilon(0.3)); // of samples of 200
  CHECK(estimate.rays == Approx(static_cast<double>(map.statistics.rays)).epsilon(0.4));
  CHECK(estimate.bytes > static_cast<double>(map.links.size() * sizeof(Link)) / 2);
  const LinkEstimate again = estimate_links(tree, some, options, {}, 200);
  CHECK(again.rays == estimate.rays);
}
