#include "host/cloud/knn.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <omp.h>
#include <set>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;

namespace {

std::vector<Vector3d> random_points(int n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Vector3d> points;
  for (int i = 0; i < n; ++i)
    points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
  return points;
}

/// The k smallest distances to other sites, world units, by looking at all of them.
std::vector<double> brute_distances(const Sites& sites, std::uint32_t site, unsigned k) {
  std::vector<double> distances;
  for (std::uint32_t other = 0; other < sites.size(); ++other)
    if (other != site) distances.push_back((sites.position(other) - sites.position(site)).norm() * sites.unit());
  std::sort(distances.begin(), distances.end());
  distances.resize(std::min<std::size_t>(k, distances.size()));
  return distances;
}

/// Compares with brute force. Which of two nearly equal distances comes first is up to float rounding; the distances
/// themselves agree to `tolerance`, a few float roundings (6e-8) of a coordinate over the distances met.
void check_against_brute_force(const Sites& sites, unsigned k, std::uint32_t step, double tolerance) {
  std::vector<Neighbour> near(k);
  for (std::uint32_t site = 0; site < sites.size(); site += step) {
    const std::vector<double> truth = brute_distances(sites, site, k);
    const unsigned count = sites.nearest(site, k, near.data());
    REQUIRE(count == truth.size());
    std::set<std::uint32_t> seen{site};
    for (unsigned j = 0; j < count; ++j) {
      CHECK(seen.insert(near[j].site).second);
      const double distance = (sites.position(near[j].site) - sites.position(site)).norm() * sites.unit();
      REQUIRE(distance == Approx(truth[j]).epsilon(tolerance));
    }
  }
}

} // namespace

TEST_CASE("nearest sites are those of a brute-force search", "[cloud][knn]") {
  const Sites sites(random_points(2000, 1));
  CHECK(sites.size() == 2000);
  for (const unsigned k : {1u, 6u, 24u, 160u})
    check_against_brute_force(sites, k, 37, 1e-5);
}

TEST_CASE("map coordinates keep their millimetres", "[cloud][knn]") {
  std::vector<Vector3d> points = random_points(2000, 2);
  for (Vector3d& p : points)
    p += Vector3d(636001e1, -848935e1, 1e6); // float would round to half a unit here
  const Sites sites(points);
  REQUIRE(sites.size() == 2000);
  check_against_brute_force(sites, 24, 37, 1e-5);
}

TEST_CASE("one far outlier does not blur the rest", "[cloud][knn]") {
  std::vector<Vector3d> points = random_points(2000, 3);
  points.emplace_back(1e6, 1e6, -1e6);
  points.emplace_back(1e300, 0, 0);
  const Sites sites(points);
  REQUIRE(sites.size() == 2002);
  std::vector<Neighbour> near(24);
  for (std::uint32_t site = 0; site < sites.size(); ++site) {
    REQUIRE(sites.nearest(site, 24, near.data()) == 24);
    if (sites.position(site).norm() > 100) continue; // for an outlier all the others are equally far, in float
    for (const Neighbour& n : near)
      CHECK(sites.position(n.site).norm() < 100);
  }
}

TEST_CASE("any scale", "[cloud][knn]") {
  for (const double scale : {1e-300, 1e-30, 1e-6, 1e6, 1e30, 1e300}) {
    std::vector<Vector3d> points = random_points(500, 4);
    for (Vector3d& p : points)
      p *= scale;
    const Sites sites(points);
    REQUIRE(sites.size() == 500);
    check_against_brute_force(sites, 8, 29, 1e-5);
  }
}

TEST_CASE("coincident points share a site", "[cloud][knn]") {
  std::vector<Vector3d> points = random_points(1000, 5);
  const std::vector<Vector3d> once = points;
  points.insert(points.end(), once.begin(), once.end());
  points.insert(points.end(), 100000, Vector3d(0.1, 0.2, 0.3)); // a kd-tree over these would search them all, always
  const Sites sites(points);
  REQUIRE(sites.size() == 1001);
  std::size_t handed_out = 0;
  std::set<std::uint32_t> seen;
  for (std::uint32_t site = 0; site < sites.size(); ++site) {
    const Sites::Points here = sites.points(site);
    handed_out += here.size();
    CHECK(std::is_sorted(here.begin(), here.end()));
    for (const std::uint32_t point : here) {
      if (here.size() < 10) CHECK(seen.insert(point).second);
      if (points[point] != points[*here.begin()]) FAIL("points of a site differ");
    }
  }
  CHECK(handed_out == points.size());
}

TEST_CASE("fewer sites than asked for", "[cloud][knn]") {
  Neighbour near[8];
  CHECK(Sites({Vector3d(1, 2, 3)}).nearest(0, 8, near) == 0);
  CHECK(Sites({Vector3d(1, 2, 3), Vector3d(1, 2, 3)}).nearest(0, 8, near) == 0);
  const Sites two({Vector3d(1, 2, 3), Vector3d(1, 2, 5)});
  REQUIRE(two.nearest(1, 8, near) == 1);
  CHECK(near[0].site == 0);
  CHECK(static_cast<double>(near[0].distance2) * two.unit() * two.unit() == Approx(4.0)); // exact but for Approx
  REQUIRE(two.nearest_to(two.to_local({1, 2, 4.75}), 8, near) == 2);
  CHECK(static_cast<double>(near[0].distance2) * two.unit() * two.unit() == Approx(0.0625));
}

TEST_CASE("sites do not depend on the number of threads", "[cloud][knn]") {
  const std::vector<Vector3d> points = random_points(30000, 6);
  const int threads = omp_get_max_threads();
  std::vector<Vector3d> before;
  for (const int count : {1, 2, 4}) {
    omp_set_num_threads(count);
    const Sites sites(points);
    std::vector<Vector3d> now;
    for (std::uint32_t site = 0; site < sites.size(); ++site)
      now.push_back(sites.position(site));
    CHECK((before.empty() || before == now));
    before = now;
  }
  omp_set_num_threads(threads);
}
