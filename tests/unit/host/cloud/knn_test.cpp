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

namespace {

bool same(const std::vector<Neighbour>& a, const std::vector<Neighbour>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Neighbour& one, const Neighbour& other) {
    return one.site == other.site && one.distance2 == other.distance2;
  });
}

std::vector<Neighbour> neighbours(const Sites& sites, std::uint32_t site, unsigned k) {
  std::vector<Neighbour> near(k);
  near.resize(sites.nearest(site, k, near.data()));
  return near;
}

/// Clouds on which searches go wrong: equal distances, densities a thousand times apart, lines, a point far off.
std::vector<Vector3d> uneven_points(std::uint64_t seed) {
  std::vector<Vector3d> points = random_points(1500, seed);
  for (int x = 0; x < 30; ++x)
    for (int y = 0; y < 30; ++y)
      points.emplace_back(2 + 0.125 * x, 0.125 * y, 0.5); // equally far, exactly
  for (const Vector3d& p : random_points(3000, seed + 1))
    points.push_back(1e-3 * p + Vector3d(0.3, 0.1, -0.2));
  for (int i = 0; i < 300; ++i)
    points.emplace_back(-3 + 0.01 * i, 2, 0);
  points.emplace_back(1e7, 0, 0);
  return points;
}

} // namespace

TEST_CASE("neighbours are the same in whatever order sites are asked for", "[cloud][knn]") {
  const Sites sites(uneven_points(7));
  const unsigned k = GENERATE(1u, 6u, 20u, 70u, 160u);
  std::vector<std::vector<Neighbour>> backwards(sites.size());
  for (std::uint32_t site = sites.size(); site-- > 0;) // each is searched for on its own
    backwards[site] = neighbours(sites, site, k);
  std::size_t different = 0;
  for (std::uint32_t site = 0; site < sites.size(); ++site) // by leaves
    different += same(neighbours(sites, site, k), backwards[site]) ? 0u : 1u;
  CHECK(different == 0);
  different = 0;
  for (std::uint32_t site = 0; site < sites.size(); ++site) {
    const unsigned other_k = site % 3 == 0 ? 160 : k;
    const std::vector<Neighbour> near = neighbours(sites, site, other_k);
    different += same({near.begin(), near.begin() + k}, backwards[site]) ? 0u : 1u;
  }
  CHECK(different == 0);
}

TEST_CASE("of equally far neighbours the first along the curve comes first", "[cloud][knn]") {
  const Sites sites(uneven_points(8));
  for (std::uint32_t site = 0; site < sites.size(); ++site) {
    const std::vector<Neighbour> near = neighbours(sites, site, 20);
    for (std::size_t j = 1; j < near.size(); ++j)
      if (near[j - 1].distance2 > near[j].distance2 ||
          (near[j - 1].distance2 == near[j].distance2 && near[j - 1].site >= near[j].site))
        FAIL("site " << site << ", neighbour " << j);
  }
}

TEST_CASE("the neighbours that are kept are those that are found", "[cloud][knn]") {
  // More sites than 16 bits count, so that some neighbours lie far off along the curve.
  std::vector<Vector3d> points = random_points(100'000, 9);
  for (Vector3d& p : points)
    p.z() = 0.1 * p.x() * p.y();
  const std::vector<Vector3d> uneven = uneven_points(10);
  points.insert(points.end(), uneven.begin(), uneven.end());
  Sites sites(points);
  std::vector<std::vector<Neighbour>> found;
  for (std::uint32_t site = 0; site < sites.size(); ++site)
    found.push_back(neighbours(sites, site, 20));
  sites.keep_neighbours(20);
  std::size_t different = 0, far = 0;
  for (std::uint32_t site = 0; site < sites.size(); ++site) {
    different += same(neighbours(sites, site, 20), found[site]) ? 0u : 1u;
    different += same(neighbours(sites, site, 6), {found[site].begin(), found[site].begin() + 6}) ? 0u : 1u;
    for (const Neighbour& near : found[site])
      far += std::max(near.site, site) - std::min(near.site, site) > 40000 ? 1u : 0u;
  }
  CHECK(different == 0);
  CHECK(far > 100);
  std::vector<Neighbour> more = neighbours(sites, 77, 56);
  more.resize(20);
  CHECK(same(more, found[77]));
  Sites few({Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(3, 0, 0)});
  few.keep_neighbours(20); // there are not as many
  CHECK(neighbours(few, 0, 20).size() == 2);
}
