#include "host/cloud/cell_polygon.h"
#include "host/cloud/splat_size.h"
#include "host/cloud/unfold.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

PointCloud sized(PointCloud cloud) {
  const Sites sites(cloud.position);
  std::vector<float> spacing = spacings_of(sites);
  rein_in_isolated(sites, spacing);
  SplatSizes sizes =
      splat_sizes(sites, cloud.normal, with_normals(sites, cloud.normal, std::move(spacing)), true, false);
  cloud.radius = std::move(sizes.radius);
  cloud.area = std::move(sizes.area);
  return cloud;
}

double area_error(const PointCloud& cloud, double truth) {
  return total(sized(cloud).area) / truth - 1;
}

SurfacePoint on_plane(std::mt19937_64& random) {
  return {{uniform(random, 0, 1), uniform(random, 0, 1), 0}, Vector3d::UnitZ()};
}

/// 16 times as many points right of x = 1/2 as left of it.
SurfacePoint on_stepped_plane(std::mt19937_64& random) {
  SurfacePoint p = on_plane(random);
  const bool left = uniform(random, 0, 1) < 1.0 / 17;
  p.position.x() = 0.5 * p.position.x() + (left ? 0 : 0.5);
  return p;
}

/// Where the surface is tested for holes: the outline of a random sampling is ragged.
SurfacePoint inside_plane(std::mt19937_64& random) {
  return {{uniform(random, 0.03, 0.97), uniform(random, 0.03, 0.97), 0}, Vector3d::UnitZ()};
}

} // namespace

TEST_CASE("a cell polygon is cut as half-planes say", "[cloud][splat_size]") {
  CellPolygon polygon(10);
  CHECK(polygon.open());
  for (const Vector2d& q : {Vector2d(2, 0), Vector2d(0, 4), Vector2d(-2, 0)})
    polygon.cut(q);
  CHECK(polygon.open());
  polygon.cut({0, -4});
  CHECK_FALSE(polygon.open());
  CHECK(polygon.area() == Approx(2 * 4)); // exact up to rounding, as all here
  CHECK(polygon.reach2() == Approx(1 + 4));
  CHECK(polygon.reach_along({1, 0}) == Approx(1));
  CHECK(polygon.reach_along({0, -1}) == Approx(2));
  CellPolygon half = polygon;
  half.cut_at({1, 0}, 0.0); // through its middle
  CHECK(half.area() == Approx(2 * 2));
  CHECK(half.reach_along({1, 0}) == Approx(0).margin(1e-12));
  polygon.cut({0, 40}); // too far to touch it
  CHECK(polygon.area() == Approx(8));
  polygon.cut({2, 4}); // cuts off a corner: x + 2y <= 5, which the corner (1, 2) just meets
  CHECK(polygon.area() == Approx(8));
  polygon.cut({1, 1});
  CHECK(polygon.area() == Approx(8 - 2)); // x + y <= 1 takes the triangle with legs of 2 at the corner (1, 2)
}

TEST_CASE("neighbours are laid flat along the surface", "[cloud][splat_size]") {
  const TangentFrame top(Vector3d::UnitZ());
  CHECK(top.u.cross(top.v).dot(top.n) == Approx(1));
  Vector2d q;
  SECTION("over an edge, outwards and inwards, by both legs") {
    REQUIRE(unfold(top, Vector3d::UnitX(), {0.3, 0.2, -0.4}, 0.5, q));
    CHECK(q.dot(top.flat({1, 0, 0})) == Approx(0.7));
    CHECK(q.dot(top.flat({0, 1, 0})) == Approx(0.2));
    REQUIRE(unfold(top, -Vector3d::UnitX(), {0.3, 0.2, 0.4}, 0.5, q));
    CHECK(q.dot(top.flat({1, 0, 0})) == Approx(0.7));
    CHECK(q.dot(top.flat({0, 1, 0})) == Approx(0.2));
  }
  SECTION("from a point on the edge itself, straight down the other face") {
    REQUIRE(unfold(top, Vector3d::UnitX(), {0, 0, -0.4}, 0.5, q));
    CHECK(q.dot(top.flat({1, 0, 0})) == Approx(0.4));
  }
  SECTION("over a sphere, by the arc") {
    const double angle = 0.3;
    const Vector3d n(std::sin(angle), 0, std::cos(angle));
    REQUIRE(unfold(top, n, n - Vector3d::UnitZ(), 0.3, q));
    CHECK(q.norm() == Approx(angle).epsilon(1e-5)); // the series' next term is t^6 15/336
  }
  SECTION("noise along the normal does not count") {
    REQUIRE(unfold(top, Vector3d::UnitZ(), {0.5, 0, 0.3}, 0.5, q));
    CHECK(q.norm() == Approx(0.5));
  }
  SECTION("not to the other side of a sheet, nor to another layer") {
    CHECK_FALSE(unfold(top, -Vector3d::UnitZ(), {0.1, 0, -0.1}, 0.5, q));
    CHECK_FALSE(unfold(top, Vector3d::UnitZ(), {0.1, 0, -1.0}, 0.5, q));
  }
}

TEST_CASE("areas of even samplings add up to the surface", "[cloud][splat_size]") {
  // method.md §4 asks for 1 %. Measured: at most 0.07 %, at the cube's corners, where 270° are laid out in a plane.
  CHECK(std::abs(area_error(fibonacci_sphere(10000), 4 * pi)) < 0.01);
  CHECK(std::abs(area_error(grid_cube(41, false), 6)) < 0.01);
  CHECK(std::abs(area_error(grid_cube(41, true), 6)) < 0.01);
  CHECK(std::abs(area_error(regular_torus(160, 64), torus_area)) < 0.01);
  CHECK(std::abs(area_error(regular_torus(200, 50), torus_area)) < 0.01);
}

TEST_CASE("areas of random samplings add up to the surface", "[cloud][splat_size]") {
  // method.md §4 asks for 2 %. Measured: 0.03 %, for Voronoi cells share the plane out whatever the density.
  for (std::uint64_t seed = 31; seed < 34; ++seed) {
    CHECK(std::abs(area_error(random_sampling(on_sphere, 10000, seed), 4 * pi)) < 0.02);
    CHECK(std::abs(area_error(random_sampling(on_cube, 10000, seed), 6)) < 0.02);
    CHECK(std::abs(area_error(random_sampling(on_torus, 10000, seed), torus_area)) < 0.02);
  }
}

TEST_CASE("the error of areas falls with the spacing", "[cloud][splat_size]") {
  double before = 1; // measured 0.83 %, 0.21 %, 0.05 %: the square of the spacing, which halves
  for (const int n : {100, 400, 1600}) {
    const double now = std::abs(area_error(fibonacci_sphere(n), 4 * pi));
    CHECK(now < 0.5 * before);
    before = now;
  }
}

TEST_CASE("no pinholes, and discs no larger than that takes", "[cloud][splat_size]") {
  // Discs cover their cells, and cells the tangent planes: nothing may stay open. 1e-4 allows for what a test point
  // needs to lie beyond the cell of its nearest splat because two tangent planes differ; measured: none of 100,000.
  const auto uncovered = [](const PointCloud& cloud, const Sampler& sampler) {
    return uncovered_share(cloud, sampler, 100000, 41);
  };
  const PointCloud sphere = sized(fibonacci_sphere(10000)),
                   random_sphere = sized(random_sampling(on_sphere, 10000, 42));
  const PointCloud cube = sized(grid_cube(41, false)), random_cube = sized(random_sampling(on_cube, 10000, 43));
  const PointCloud torus = sized(random_sampling(on_torus, 10000, 44)),
                   plane = sized(random_sampling(on_plane, 10000, 45));
  CHECK(uncovered(sphere, on_sphere) <= 1e-4);
  CHECK(uncovered(random_sphere, on_sphere) <= 1e-4);
  CHECK(uncovered(cube, on_cube) <= 1e-4);
  CHECK(uncovered(random_cube, on_cube) <= 1e-4);
  CHECK(uncovered(torus, on_torus) <= 1e-4);
  CHECK(uncovered(plane, inside_plane) <= 1e-4);
  // Squares: 1.25 x 1.2 (the overlap) = 1.50; the spiral 1.44. The farthest corner of a random Voronoi cell is at 1.83
  // times the radius of a disc of its area on average: 2.20.
  CHECK(mean_waste(sphere) < 1.55);
  CHECK(mean_waste(cube) < 1.6);
  CHECK(mean_waste(random_sphere) < 2.3);
  CHECK(mean_waste(random_cube) < 2.3);
  CHECK(mean_waste(torus) < 2.3);
  CHECK(mean_waste(plane) < 2.35);
}

TEST_CASE("no pinholes where the density steps by 16", "[cloud][splat_size]") {
  for (std::uint64_t seed = 46; seed < 49; ++seed) {
    const PointCloud plane = sized(random_sampling(on_stepped_plane, 17000, seed));
    CHECK(uncovered_share(plane, inside_plane, 100000, seed) <= 1e-4);
    CHECK(mean_waste(plane) < 2.35);
    // The outline lies half a local spacing, up to 0.011 on the coarse half, outside of the last points.
    CHECK(total(plane.area) == Approx(1).margin(0.04));
  }
}

TEST_CASE("an open surface ends half a spacing outside its last points", "[cloud][splat_size]") {
  PointCloud plane;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j)
      add(plane, Vector3d(i + 0.5, j + 0.5, 0), Vector3d::UnitZ());
  const PointCloud cloud = sized(plane);
  CHECK(total(cloud.area) == Approx(900).epsilon(0.01)); // measured 0.2 %: the corners' spacing is a guess
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    CHECK(static_cast<double>(cloud.area[i]) == Approx(1).epsilon(0.2));
    CHECK(static_cast<double>(cloud.radius[i]) == Approx(splat_overlap / std::sqrt(2)).epsilon(0.2));
  }
}

TEST_CASE("the sides of a thin sheet have their area each", "[cloud][splat_size]") {
  std::mt19937_64 random(50);
  PointCloud sheet;
  for (int i = 0; i < 20000; ++i) { // 0.001 thick at a spacing of 0.01
    const SurfacePoint p = on_plane(random);
    const double side = i % 2 == 0 ? 1 : -1;
    add(sheet, p.position + Vector3d(0, 0, 0.0005 * side), side * Vector3d::UnitZ());
  }
  CHECK(total(sized(sheet).area) == Approx(2).epsilon(0.03)); // 1.6 % of it outside of the outline
}

TEST_CASE("coincident points share a cell", "[cloud][splat_size]") {
  PointCloud once = fibonacci_sphere(2000), cloud = once;
  for (int copy = 0; copy < 2; ++copy)
    for (std::size_t i = 0; i < once.size(); i += 3)
      add(cloud, once.position[i], once.normal[i].cast<double>());
  const PointCloud single = sized(once), shared = sized(cloud);
  CHECK(total(shared.area) == Approx(total(single.area)).epsilon(1e-5)); // sums of floats
  for (std::size_t i = 0; i < once.size(); ++i) {
    // The copies move the median, which coordinates are counted from: some ten roundings of floats differ.
    CHECK(static_cast<double>(shared.radius[i]) == Approx(static_cast<double>(single.radius[i])).epsilon(1e-5));
    CHECK(static_cast<double>(shared.area[i]) == Approx(static_cast<double>(single.area[i]) / (i % 3 == 0 ? 3 : 1)));
  }
}

TEST_CASE("outliers stay small", "[cloud][splat_size]") {
  for (const int group : {1, 2, 3}) {
    PointCloud cloud = random_sampling(on_sphere, 5000, 51);
    for (int i = 0; i < group; ++i)
      add(cloud, Vector3d(1e6, 1e5 + 3.0 * i, 0), Vector3d::UnitZ());
    const PointCloud result = sized(cloud);
    std::vector<float> sorted = result.radius;
    std::sort(sorted.begin(), sorted.end());
    const double median = static_cast<double>(sorted[sorted.size() / 2]);
    for (int i = 0; i < group; ++i) // 3.6 spacings at most; half the splats have 1.15 or more
      CHECK(static_cast<double>(result.radius[5000 + i]) < 4 * median);
    CHECK(total(result.area) == Approx(4 * pi).epsilon(0.02));
  }
}

TEST_CASE("sizes do not depend on threads, and follow the scale", "[cloud][splat_size]") {
  const PointCloud cloud = random_sampling(on_cube, 5000, 52);
  const int threads = omp_get_max_threads();
  const PointCloud one = sized(cloud);
  for (const int count : {1, 2, 4}) {
    omp_set_num_threads(count);
    const PointCloud again = sized(cloud);
    CHECK(again.radius == one.radius);
    CHECK(again.area == one.area);
  }
  omp_set_num_threads(threads);
  for (const double scale : {1e-6, 1e6}) {
    PointCloud scaled = cloud;
    for (Vector3d& p : scaled.position)
      p = scale * p + 1e6 * scale * Vector3d(1, -2, 3);
    const PointCloud result = sized(scaled);
    for (std::size_t i = 0; i < cloud.size(); ++i) // doubles at 4e6 sizes from the origin: 1e-9 of the size
      REQUIRE(static_cast<double>(result.radius[i]) ==
              Approx(scale * static_cast<double>(one.radius[i])).epsilon(1e-4));
  }
}
