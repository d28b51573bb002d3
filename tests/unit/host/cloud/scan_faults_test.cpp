/// What real scans bring, each on a made cloud: strays, missing normals, terrain, thin walls, noise, voxels, cables,
/// rooms, sheets.
#include "tests/unit/host/cloud/completed_cloud.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

/// A turned vase on y = 0, height 1: waist, foot and mouth, the ends closed. Evenly spread.
double vase_radius(double y) {
  return 0.2 + 0.1 * std::cos(2 * pi * y);
}

PointCloud vase(int rows) {
  PointCloud cloud;
  const double step = 1.0 / rows;
  for (int i = 0; i < rows; ++i) {
    const double y = (i + 0.5) * step, r = vase_radius(y), slope = -0.2 * pi * std::sin(2 * pi * y);
    const int around = static_cast<int>(std::lround(2 * pi * r / step));
    for (int j = 0; j < around; ++j) {
      const double a = 2 * pi * (j + 0.5 * (i % 2)) / around;
      const Vector3d out(std::cos(a), 0, std::sin(a));
      add(cloud, r * out + y * Vector3d::UnitY(), (out - slope * Vector3d::UnitY()).normalized());
    }
  }
  for (const double y : {0.0, 1.0})
    for (double r = 0.5 * step; r < vase_radius(y) - 0.3 * step; r += step)
      for (int j = 0, around = std::max(3, static_cast<int>(std::lround(2 * pi * r / step))); j < around; ++j) {
        const double a = 2 * pi * j / around;
        add(cloud, {r * std::cos(a), y, r * std::sin(a)}, Vector3d(0, y == 0.0 ? -1 : 1, 0));
      }
  return cloud;
}

/// Floaters at 1 to 40 sizes, facing anywhere.
void add_strays(PointCloud& cloud, int count, std::uint64_t seed, double nearest) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) {
    const Vector3d direction = on_sphere(random).position;
    const double distance = nearest * std::pow(40.0 / nearest, uniform(random, 0, 1));
    add(cloud, direction * distance, on_sphere(random).position);
  }
}

PointCloud without_normals(PointCloud cloud) {
  cloud.normal.clear();
  return cloud;
}

double share_up(const PointCloud& cloud, int axis) {
  const auto up =
      std::count_if(cloud.normal.begin(), cloud.normal.end(), [&](const Vector3f& n) { return n[axis] > 0; });
  return static_cast<double>(up) / static_cast<double>(cloud.size());
}

} // namespace

TEST_CASE("strays do not decide sides, and are counted", "[cloud][complete][strays]") {
  const PointCloud body = vase(60);
  for (std::uint64_t draw = 0; draw < 10; ++draw) {
    PointCloud cloud = body;
    add_strays(cloud, static_cast<int>(body.size() / 100), draw, 1.0);
    cloud = without_normals(cloud);
    CompleteOptions options;
    options.strays = StrayPolicy::shrink;
    const CloudReport report = complete(cloud, options);
    check_promises(cloud);
    REQUIRE(cloud.size() == body.size() + body.size() / 100);
    PointCloud front = cloud;
    front.position.resize(body.size());
    CHECK(agreement(front, body.normal) >= 0.99);
    std::size_t strays = 0;
    for (std::size_t i = body.size(); i < cloud.size(); ++i)
      strays += cloud.structure[i] == Structure::stray;
    CHECK(10 * strays >= 9 * (cloud.size() - body.size())); // some lie beside others of them
    REQUIRE(!report.notes.empty());
    CHECK(report.notes.front().find("strays") != std::string::npos);
  }
}

TEST_CASE("floaters get no discs larger than the surface's, and leave the area alone", "[cloud][complete][strays]") {
  PointCloud alone = vase(60);
  complete(alone);
  const double area = total(alone.area);
  const float largest = *std::max_element(alone.radius.begin(), alone.radius.end());
  PointCloud cloud = vase(60);
  add_strays(cloud, static_cast<int>(cloud.size() / 50), 7, 1.0);
  for (const StrayPolicy policy : {StrayPolicy::drop, StrayPolicy::shrink}) {
    PointCloud tried = cloud;
    CompleteOptions options;
    options.strays = policy;
    complete(tried, options);
    CHECK(*std::max_element(tried.radius.begin(), tried.radius.end()) <= 1.1f * largest);
    CHECK(total(tried.area) == Approx(area).epsilon(policy == StrayPolicy::drop ? 0.005 : 0.03)); // 2 % of the points
  }
  // A scan that thins out with the distance has none: each neighbourhood is as sparse as the next.
  PointCloud ground;
  for (double r = 1; r < 200; r *= 1.02)
    for (int j = 0; j < 300; ++j)
      add(ground, {r * std::cos(j * pi / 150), 0.0, r * std::sin(j * pi / 150)}, Vector3d::UnitY());
  const std::size_t all = ground.size();
  complete(ground);
  CHECK(ground.size() == all);
}

TEST_CASE("missing normals are estimated beside those that are given", "[cloud][complete]") {
  const PointCloud body = vase(60);
  for (const float missing : {0.0f, std::numeric_limits<float>::quiet_NaN()})
    for (const unsigned every : {2u, 1u}) {
      PointCloud cloud = body;
      std::mt19937_64 random(3);
      for (Vector3f& n : cloud.normal)
        if (every == 1 || random() % 20 < 9) n = Vector3f::Constant(missing);
      const CloudReport report = complete(cloud);
      REQUIRE(cloud.size() == body.size()); // no point is lost
      check_promises(cloud);
      CHECK(agreement(cloud, body.normal) > 0.995);
      CHECK(report.normals_from.find("estimated") != std::string::npos);
    }
}

TEST_CASE("a terrain tile with its corner at the origin faces up", "[cloud][complete]") {
  std::mt19937_64 random(5);
  PointCloud cloud;
  for (int i = 0; i < 9000; ++i) {
    const double x = uniform(random, 0, 300), y = uniform(random, 0, 300);
    cloud.position.emplace_back(x, y, 525 + 10 * std::sin(x / 40) * std::cos(y / 60));
  }
  const CloudReport report = complete(cloud);
  CHECK(report.kind == CloudKind::terrain);
  CHECK(report.up == Vector3d(0, 0, 1));
  CHECK(share_up(cloud, 2) == 1.0);
}

TEST_CASE("coordinates of a map have z upwards, those of a model far from its origin tell nothing",
          "[cloud][complete]") {
  std::mt19937_64 random(15);
  const auto wall_at = [&](const Vector3d& place) {
    PointCloud cloud; // along x, as high as wide: nothing else tells
    for (int i = 0; i < 4000; ++i)
      cloud.position.push_back(place +
                               Vector3d(uniform(random, 0, 20), uniform(random, 0, 0.2), uniform(random, 0, 20)));
    return complete(cloud);
  };
  const CloudReport utm = wall_at({660000, 5648000, 240});
  CHECK(utm.kind == CloudKind::map);
  REQUIRE(utm.up.has_value());
  CHECK(*utm.up == Vector3d::UnitZ());
  CHECK(wall_at({10, 20, 3}).kind != CloudKind::map);
  CHECK(wall_at({660000, 5648000, 240000}).kind != CloudKind::map);
}

TEST_CASE("a thin wall scanned on both sides has the discs of either side alone", "[cloud][complete]") {
  PointCloud one, both;
  std::mt19937_64 random(6);
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i < 50; ++i)
      for (int j = 0; j < 50; ++j) {
        const Vector3d p(0.02 * (i + uniform(random, 0, 0.7)), 0.02 * (j + uniform(random, 0, 0.7)), 0.002 * side);
        add(both, p, side * Vector3d::UnitZ());
        if (side > 0) add(one, p, Vector3d::UnitZ());
      }
  complete(one);
  complete(both);
  // Each side has its own random places, and rims end half a spacing outside the last points of either.
  CHECK(total(both.area) == Approx(2 * total(one.area)).epsilon(0.03));
  CHECK(mean_waste(both) == Approx(mean_waste(one)).epsilon(0.03));
}

TEST_CASE("noise as large as the spacing leaves a field of normals", "[cloud][complete]") {
  for (const double noise : {0.0, 0.5, 1.0}) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> gauss;
    PointCloud cloud;
    for (int i = 0; i < 80; ++i)
      for (int j = 0; j < 80; ++j)
        cloud.position.emplace_back(i + uniform(random, 0, 1), noise * gauss(random), j + uniform(random, 0, 1));
    complete(cloud);
    CHECK(share_up(cloud, 1) == 1.0);
    double tilt = 0;
    for (const Vector3f& n : cloud.normal)
      tilt += std::acos(std::min(1.0, static_cast<double>(n.y()))) * 180 / pi / static_cast<double>(cloud.size());
    CHECK(tilt < (noise == 0.0 ? 0.01 : noise == 0.5 ? 10.0 : 20.0)); // degrees; measured 0, 2.7, 5.6
  }
}

TEST_CASE("points on a lattice, one a voxel, face outwards on every terrace", "[cloud][complete]") {
  // A ball of 40 voxels: its terraces are flat, and their rims climb by whole steps.
  PointCloud cloud;
  std::vector<Vector3f> truth;
  const auto inside = [](int x, int y, int z) { return x * x + y * y + z * z < 40 * 40; };
  for (int x = -40; x <= 40; ++x)
    for (int y = -40; y <= 40; ++y)
      for (int z = -40; z <= 40; ++z) {
        if (!inside(x, y, z) || (inside(x - 1, y, z) && inside(x + 1, y, z) && inside(x, y - 1, z) &&
                                 inside(x, y + 1, z) && inside(x, y, z - 1) && inside(x, y, z + 1)))
          continue;
        cloud.position.emplace_back(x, y, z);
        truth.push_back(cloud.position.back().normalized().cast<float>());
      }
  complete(cloud);
  CHECK(agreement(cloud, truth) == 1.0);
}

TEST_CASE("cables stay thin", "[cloud][complete]") {
  PointCloud cloud;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 40; ++j)
      cloud.position.emplace_back(0.5 * i, 0.5 * j, 0.0);
  const std::size_t ground = cloud.size();
  for (const double y : {5.0, 10.0, 15.0})
    for (int i = 0; i < 600; ++i)
      cloud.position.emplace_back(0.1 * i, y, 12 - 3 * std::sin(pi * i / 600));
  complete(cloud);
  float widest = 0;
  std::size_t lines = 0;
  for (std::size_t i = ground; i < cloud.size(); ++i) {
    widest = std::max(widest, cloud.radius[i]);
    lines += cloud.structure[i] == Structure::line;
  }
  CHECK(10 * lines > 9 * (cloud.size() - ground)); // their ends have too few neighbours to be sure
  CHECK(widest < 0.12f);                           // about their spacing, and not the 1.8 of a cell that nothing bounds
  cloud.normal.resize(ground);
  CHECK(std::all_of(cloud.normal.begin(), cloud.normal.end(), [](const Vector3f& n) { return n.z() > 0; }));
}

TEST_CASE("axes of Gaussians get sides, with strays shrunk as with strays left out", "[cloud][complete]") {
  PointCloud ball;
  std::mt19937_64 random(14);
  std::normal_distribution<double> gauss;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
    add(ball, p, i % 2 == 0 ? p : Vector3d(-p));
  }
  for (int i = 0; i < 20; ++i)
    add(ball, 5 * Vector3d(gauss(random), gauss(random), gauss(random)), Vector3d::UnitX());
  ball.normals_unsigned = true;
  CompleteOptions options;
  options.strays = StrayPolicy::shrink;
  CloudReport report;
  complete_cloud(ball, options, report);
  std::size_t outwards = 0;
  for (std::size_t i = 0; i < 3000; ++i)
    outwards += ball.normal[i].cast<double>().dot(ball.position[i]) > 0;
  CHECK(outwards == 3000);
}

TEST_CASE("ground seen from a tripod keeps its area, however far apart its outer points are", "[cloud][complete]") {
  // Rings of a scanner 1.6 m above the ground: from 0.03 m apart at its feet to 4 m at 60 m.
  PointCloud cloud;
  for (double down = 1.0; down > 0.0267; down -= 0.0018)
    for (int k = 0; k < 360; ++k) {
      const double r = 1.6 / std::tan(down), angle = k * pi / 180;
      cloud.position.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
    }
  CompleteOptions options;
  options.strays = StrayPolicy::keep;
  for (const bool given : {false, true}) {
    PointCloud scan = cloud;
    if (given) scan.normal.assign(scan.size(), Vector3f::UnitZ());
    CloudReport report;
    complete_cloud(scan, options, report);
    CHECK(total(scan.area) == Approx(pi * 60 * 60).epsilon(0.1)); // its rim is half a ring wider or narrower
  }
}

TEST_CASE("a closed surface with normals keeps its area, however unevenly it was scanned", "[cloud][complete]") {
  std::mt19937_64 random(13);
  std::normal_distribution<double> gauss;
  PointCloud ball;
  while (ball.size() < 12000) { // 85 % of the points on a cap
    const Vector3d p = Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
    if (p.z() > 0.7 || uniform(random, 0, 1) < 0.03) add(ball, p, p);
  }
  const CloudReport report = complete(ball);
  CHECK(report.kind == CloudKind::model);
  CHECK(total(ball.area) == Approx(4 * pi).epsilon(0.02));
}

TEST_CASE("no disc is wide because its point is alone, with normals or without", "[cloud][complete]") {
  // A dense floor, and beyond its edge one point an object.
  PointCloud cloud;
  std::mt19937_64 random(12);
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      cloud.position.emplace_back(0.1 * (i + uniform(random, 0, 0.5)), 0.1 * (j + uniform(random, 0, 0.5)), 0.0);
  for (int i = 0; i < 40; ++i)
    cloud.position.emplace_back(6 + 0.3 * i, uniform(random, 0, 6), uniform(random, 0, 4));
  CompleteOptions options;
  options.strays = StrayPolicy::keep;
  const auto widest = [&](PointCloud scan) {
    CloudReport report;
    complete_cloud(scan, options, report);
    return *std::max_element(scan.radius.begin(), scan.radius.end());
  };
  CHECK(widest(cloud) < 16 * 0.11f); // of the median spacing, about 0.1
  cloud.normal.assign(cloud.size(), Vector3f::UnitZ());
  CHECK(widest(cloud) < 16 * 0.11f);
}

TEST_CASE("a room faces its camera, and is known by its walls where there is none", "[cloud][complete]") {
  PointCloud room;
  std::mt19937_64 random(9);
  const Vector3d size(4, 3, 2.5);
  for (int i = 0; i < 5000; ++i) {
    Vector3d p(uniform(random, 0, 4), uniform(random, 0, 3), uniform(random, 0, 2.5)), n = Vector3d::Zero();
    const auto face = static_cast<int>(random() % 6);
    p[face / 2] = face % 2 == 0 ? 0.0 : size[face / 2];
    n[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
    add(room, p, n);
  }
  PointCloud bare = without_normals(room);
  CHECK(complete(bare).kind == CloudKind::room);
  CHECK(agreement(bare, room.normal) > 0.99);
  PointCloud given = room;
  CHECK(complete(given).normals_from == "file"); // not turned to face outwards
  CHECK(agreement(given, room.normal) == 1.0);
  // A box as small as a toy is a body, unless somebody looks from inside.
  for (const bool looked_at : {false, true}) {
    PointCloud toy = without_normals(room);
    for (Vector3d& p : toy.position)
      p *= 0.01;
    CompleteOptions options;
    if (looked_at) options.eyes = {Vector3d(0.005, 0.004, 0.015)};
    complete(toy, options);
    CHECK(agreement(toy, room.normal) == Approx(looked_at ? 1.0 : 0.0).margin(0.01));
  }
}

TEST_CASE("points face the scanner that saw them", "[cloud][complete]") {
  // A partition wall, scanned from both of its sides.
  PointCloud cloud;
  cloud.stations = {Vector3d(100, 200, 5), Vector3d(100, 200, -5)};
  std::vector<Vector3f> truth;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      for (std::uint16_t k = 0; k < 2; ++k) {
        cloud.position.emplace_back(98 + i / 15.0, 198 + j / 15.0, k == 0 ? 0.1 : -0.1);
        cloud.station.push_back(k);
        truth.push_back(Vector3f(0, 0, k == 0 ? 1 : -1));
      }
  PointCloud far = cloud;
  const CloudReport report = complete(cloud);
  CHECK(report.kind == CloudKind::station);
  CHECK(report.normals_from == "estimated (towards the 2 scanner positions)");
  CHECK(agreement(cloud, truth) == 1.0);
  // A position that cannot have seen them, as files without a pose have it, tells nothing.
  far.stations = {Vector3d::Zero(), Vector3d::Zero()};
  for (Vector3d& p : far.position)
    p += Vector3d(6e5, 8e5, 0);
  CHECK(complete(far).stations.empty());
}

TEST_CASE("faces stored both ways round are sheets", "[cloud][complete]") {
  PointCloud cloud;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      cloud.position.emplace_back(i, j, 0);
  for (std::uint32_t i = 0; i < 19; ++i)
    for (std::uint32_t j = 0; j < 19; ++j) {
      const std::uint32_t a = 20 * i + j, b = a + 20;
      cloud.triangle.push_back({a, b, a + 1});
      cloud.triangle.push_back({a, a + 1, b});
    }
  complete(cloud);
  CHECK(std::all_of(cloud.structure.begin(), cloud.structure.end(), [](Structure s) { return s == Structure::sheet; }));
}
