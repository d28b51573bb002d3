#include "host/cloud/normals.h"
#include "host/cloud/orient.h"
#include "host/cloud/sensor_view.h"
#include "host/cloud/splat_size.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

struct Oriented {
  double agree = 0; ///< share of sites whose normal is on the true normal's side; ties at edges count
  std::string how;
};

std::string orient(const Sites& sites, const OrientationEvidence& given, std::vector<Vector3f>& normals,
                   const std::vector<Structure>& structure = {}) {
  std::vector<float> spacing = spacings_of(sites);
  rein_in_isolated(sites, spacing);
  const FreeSpace space(sites, spacing, 128);
  OrientationEvidence evidence = given;
  evidence.kind =
      recognise_kind(sites, spacing, normals, structure, space, {!given.stations.empty(), {}, nullptr, {}, false});
  return orient_normals(sites, evidence, space, normals).how;
}

Oriented orient(const PointCloud& cloud, const OrientationEvidence& evidence = {}) {
  const Sites sites(cloud.position);
  std::vector<Structure> structure;
  std::vector<Vector3f> normals = estimate_normals(sites, &structure);
  Oriented result;
  result.how = orient(sites, evidence, normals, structure);
  std::size_t agree = 0;
  for (std::uint32_t s = 0; s < sites.size(); ++s) // -0.01: a point on an edge may have taken the other face's normal
    agree += normals[s].dot(cloud.normal[*sites.points(s).begin()]) > -0.01f;
  result.agree = static_cast<double>(agree) / sites.size();
  return result;
}

PointCloud moved(PointCloud cloud, const Vector3d& by) {
  for (Vector3d& p : cloud.position)
    p += by;
  return cloud;
}

void append(PointCloud& cloud, const PointCloud& other) {
  cloud.position.insert(cloud.position.end(), other.position.begin(), other.position.end());
  cloud.normal.insert(cloud.normal.end(), other.normal.begin(), other.normal.end());
}

} // namespace

TEST_CASE("closed surfaces face outwards", "[cloud][orient]") {
  // Wherever they are: about the origin, beside it, far from it. 99.9 %: of the order of one point beside a corner.
  for (const Vector3d& place : {Vector3d(0, 0, 0), Vector3d(0, 0, 5), Vector3d(1e6, -2e6, 3e5)}) {
    for (const PointCloud& cloud :
         {fibonacci_sphere(10000), regular_torus(160, 64), grid_cube(41, false), random_sampling(on_sphere, 10000, 21),
          random_sampling(on_torus, 10000, 22), random_sampling(on_cube, 10000, 23)}) {
      const Oriented result = orient(moved(cloud, place));
      CHECK(result.agree >= 0.999);
      CHECK(result.how == "outwards");
    }
  }
}

TEST_CASE("separate bodies face outwards each", "[cloud][orient]") {
  PointCloud cloud = fibonacci_sphere(5000);
  append(cloud, moved(fibonacci_sphere(5000), {3, 0, 0}));
  append(cloud, moved(grid_cube(6, false), {0, 5, 0})); // a small one of its own
  CHECK(orient(cloud).agree == 1.0);
}

TEST_CASE("the two sides of a plate oppose each other", "[cloud][orient]") {
  // 1.2 spacings thick, so that some of the nearest neighbours are on the other side.
  PointCloud plate;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      for (const double side : {-1.0, 1.0})
        add(plate, Vector3d(i + 0.25 * side, j + 0.1 * side, 0.6 * side), side * Vector3d::UnitZ());
  const Sites sites(plate.position);
  std::vector<Vector3f> normals;
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    normals.push_back(Vector3f::UnitZ() * (s % 3 == 0 ? -1.0f : 1.0f));
  CHECK(orient(sites, {}, normals) == "outwards");
  std::size_t agree = 0;
  for (std::uint32_t s = 0; s < sites.size(); ++s)
    agree += normals[s].dot(plate.normal[*sites.points(s).begin()]) > 0;
  CHECK(agree == plate.size());
}

TEST_CASE("terrain faces upwards along the axis in which it is thin", "[cloud][orient]") {
  for (int axis = 0; axis < 3; ++axis) {
    std::mt19937_64 random(24);
    PointCloud cloud;
    for (int i = 0; i < 8000; ++i) {
      const double x = uniform(random, -50, 50), y = uniform(random, -50, 50);
      Vector3d p, normal;
      p[(axis + 1) % 3] = x;
      p[(axis + 2) % 3] = y;
      p[axis] = 2 * std::sin(0.2 * x) * std::cos(0.15 * y) - 100;
      normal[(axis + 1) % 3] = -0.4 * std::cos(0.2 * x) * std::cos(0.15 * y);
      normal[(axis + 2) % 3] = 0.3 * std::sin(0.2 * x) * std::sin(0.15 * y);
      normal[axis] = 1;
      // Seen from the origin, 100 above, it would be a depth image: from half a million away it is not.
      p[(axis + 1) % 3] += 5e5;
      add(cloud, p, normal.normalized());
    }
    const Oriented result = orient(cloud);
    CHECK(result.how == std::string("upwards along ") + "xyz"[axis]);
    CHECK(result.agree == 1.0);
  }
}

TEST_CASE("a viewpoint turns every normal towards it", "[cloud][orient]") {
  PointCloud cloud = fibonacci_sphere(5000);
  for (Vector3f& n : cloud.normal)
    n = -n;
  const Oriented inside = orient(cloud, {Vector3d(0.1, 0, 0), {}, {}, {}, {}});
  CHECK(inside.agree == 1.0);
  CHECK(inside.how == "towards the viewpoint");
}

TEST_CASE("a depth image is seen from its sensor", "[cloud][orient]") {
  // A wall with a ball before it, as a camera at the origin that looks along z records them: one depth a pixel.
  PointCloud cloud;
  for (int i = -100; i < 100; ++i)
    for (int j = -100; j < 100; ++j) {
      const Vector3d ray = Vector3d(i / 180.0, j / 180.0, 1).normalized();
      const Vector3d centre(0.2, 0.1, 2.5);
      const double b = ray.dot(centre), c = centre.squaredNorm() - 0.64;
      if (b * b > c) {
        const Vector3d p = (b - std::sqrt(b * b - c)) * ray;
        add(cloud, p, (p - centre).normalized());
      } else {
        add(cloud, ray * (5 / ray.z()), -Vector3d::UnitZ());
      }
    }
  const Sites sites(cloud.position);
  const SensorView view = sensor_view(sites, sites.to_local({0, 0, 0}));
  CHECK(view.one_depth > 0.97); // the rest: the ball's outline
  CHECK(view.lattice);
  CHECK_FALSE(view.all_around);
  const Oriented result = orient(cloud);
  CHECK(result.how == "towards the sensor at the origin");
  CHECK(result.agree > 0.999); // an estimate across the outline may face anywhere

  // The same from another place: things lie behind one another.
  CHECK_FALSE(sensor_view(sites, sites.to_local({6, 0, 2})).convincing());
  // Bodies with a back.
  const Sites ball(moved(fibonacci_sphere(10000), {0, 0, 4}).position);
  CHECK(sensor_view(ball, ball.to_local({0, 0, 0})).one_depth < 0.7);
  // An object about the origin has one depth a direction, too, or it is seen from too far.
  for (const PointCloud& object : {fibonacci_sphere(10000), random_sampling(on_cube, 10000, 28)}) {
    const Sites around(object.position);
    CHECK_FALSE(sensor_view(around, around.to_local({0, 0, 0})).convincing());
  }
  CHECK_FALSE(sensor_view(sites, sites.to_local({0, 0, -1e5})).convincing());
}

TEST_CASE("a scanner in the middle of a court is told by its even angles", "[cloud][orient]") {
  // A floor and four walls, as a scanner that turns records them: a grid of azimuth and elevation.
  PointCloud cloud;
  for (int i = 0; i < 360; ++i)
    for (int j = -40; j < 20; ++j) {
      const double azimuth = i * pi / 180, elevation = j * pi / 180;
      const Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation));
      double t = ray.z() < 0 ? -1.7 / ray.z() : 1e30;
      Vector3d normal = Vector3d::UnitZ();
      for (int axis = 0; axis < 2; ++axis) {
        const double wall = std::copysign(axis == 0 ? 9.0 : 5.0, ray[axis]);
        if (wall / ray[axis] < t) t = wall / ray[axis], normal = -Vector3d::Unit(axis) * std::copysign(1.0, ray[axis]);
      }
      add(cloud, t * ray, normal);
    }
  const Sites sites(cloud.position);
  const SensorView view = sensor_view(sites, sites.to_local({0, 0, 0}));
  CHECK(view.convincing());
  CHECK(view.all_around);
  CHECK(view.evenness > -0.3);
  const Oriented result = orient(cloud);
  CHECK(result.how == "towards the sensor at the origin");
  CHECK(result.agree > 0.999);
  // The same court sampled evenly by area, as a model is: not from the origin, and nobody knows that it is a court.
  PointCloud even;
  std::mt19937_64 random(29);
  for (int i = 0; i < 20000; ++i)
    add(even, {uniform(random, -9, 9), uniform(random, -5, 5), -1.7}, Vector3d::UnitZ());
  for (int i = 0; i < 10000; ++i)
    add(even, {uniform(random, -9, 9), random() % 2 ? -5.0 : 5.0, uniform(random, -1.7, 1.7)}, Vector3d::UnitY());
  const Sites even_sites(even.position);
  CHECK_FALSE(sensor_view(even_sites, even_sites.to_local({0, 0, 0})).convincing());
}

TEST_CASE("noise of a third of the spacing does not upset the sides", "[cloud][orient]") {
  PointCloud cloud = random_sampling(on_sphere, 10000, 26);
  std::mt19937_64 random(27);
  std::normal_distribution<double> noise(0, 0.3 * std::sqrt(4 * pi / 10000));
  for (Vector3d& p : cloud.position)
    p *= 1 + noise(random);
  CHECK(orient(cloud).agree > 0.998); // measured 1.0; half a spacing gives 0.9986
}

TEST_CASE("fragments follow the surface they lie beside", "[cloud][orient]") {
  // Islands of a dozen points, four spacings above a large ball: nobody has a neighbour on both.
  PointCloud cloud = fibonacci_sphere(20000);
  std::mt19937_64 random(25);
  for (int island = 0; island < 20; ++island) {
    const Vector3d at = on_sphere(random).position, u = at.unitOrthogonal(), v = at.cross(u);
    for (int i = 0; i < 12; ++i)
      add(cloud, 1.1 * at + 0.001 * (uniform(random, -1, 1) * u + uniform(random, -1, 1) * v), at);
  }
  CHECK(orient(cloud).agree == 1.0);
}
