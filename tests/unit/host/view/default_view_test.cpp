#include "host/scene/lighting.h"
#include "host/view/default_light.h"
#include "tests/unit/host/view/shapes.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

WorldSplats splats_of(PointCloud cloud) {
  WorldSplats splats;
  splats.cloud = std::move(cloud);
  splats.cloud.colour.assign(splats.cloud.size(), Eigen::Vector3f(0.5f, 0.5f, 0.5f));
  return splats;
}

WorldSplats splats_of(const ShapeGeometry& geometry, double spacing) {
  return splats_of(shape(geometry, spacing));
}

WorldSplats of_kind(PointCloud cloud, CloudKind kind) {
  WorldSplats splats = splats_of(std::move(cloud));
  splats.reports.resize(1);
  splats.reports[0].kind = kind;
  splats.reports[0].kind_reason = "of the test";
  return splats;
}

/// Largest distance from the middle of the frame, 1 at its border.
double fill(const Scene& scene, const PointCloud& cloud, std::size_t count) {
  const auto m = world_to_ndc(scene);
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d& p = cloud.position[i];
    double out[4];
    for (int c = 0; c < 4; ++c)
      out[c] = m[c] * p.x() + m[4 + c] * p.y() + m[8 + c] * p.z() + m[12 + c];
    most = std::max({most, std::fabs(2.0 * out[0] / out[3] - 1.0), std::fabs(2.0 * out[1] / out[3] - 1.0)});
  }
  return most;
}

double fill(const Scene& scene, const PointCloud& cloud) {
  return fill(scene, cloud, cloud.size());
}

Vector3d view_of(const Scene& scene) {
  return (scene.camera.look_at - scene.camera.position).normalized();
}

} // namespace

TEST_CASE("the whole object is in the frame and fills it, at any size and place") {
  for (const double s : {1e-6, 1.0, 1e6})
    for (const double at : {0.0, 1e6}) {
      const WorldSplats splats =
          splats_of(BoxShape{Vector3d(at, at, at) * s, Vector3d(at + 1, at + 2, at + 0.5) * s, false}, 0.05 * s);
      Scene scene;
      choose_camera(scene, splats);
      CHECK(fill(scene, splats.cloud) < 1.0);
      CHECK(fill(scene, splats.cloud) > 0.8);
    }
}

TEST_CASE("strays do not make the object small in its frame") {
  PointCloud cloud = statue();
  const std::size_t count = cloud.size();
  cloud.structure.assign(count, Structure::surface);
  for (int i = 0; i < 200; ++i) { // two in a hundred, out to forty sizes
    cloud.position.emplace_back(40.0 * std::cos(i), 0.2 * i, 40.0 * std::sin(i));
    cloud.normal.emplace_back(0.0f, 1.0f, 0.0f);
    cloud.radius.push_back(0.1f);
    cloud.area.push_back(0.03f);
    cloud.structure.push_back(Structure::stray);
  }
  const WorldSplats splats = splats_of(std::move(cloud));
  Scene scene;
  choose_camera(scene, splats);
  CHECK(fill(scene, splats.cloud, count) < 1.05);
  CHECK(fill(scene, splats.cloud, count) > 0.8);
}

TEST_CASE("a wide flat surface is terrain, seen from the side it faces") {
  for (const double side : {1.0, -1.0}) {
    const WorldSplats splats =
        splats_of(QuadShape{Vector3d(0, 0, 0), Vector3d(10, 0, 0), Vector3d(0, side * 8, 0)}, 0.2);
    Scene scene;
    const ChosenView view = choose_camera(scene, splats);
    CHECK_THAT(view.sentence, Catch::Contains("terrain"));
    CHECK(side * scene.camera.position.z() > 0.0);
  }
}

TEST_CASE("terrain and maps are seen from the south, 35 degrees down") {
  for (const CloudKind kind : {CloudKind::terrain, CloudKind::map}) {
    Scene scene;
    choose_camera(scene, of_kind(shape(QuadShape{{0, 0, 0}, {10, 0, 0}, {0, 8, 0}}, 0.2), kind));
    CHECK(scene.camera.position.y() < 0.0);
    CHECK(view_of(scene).z() == Approx(-std::sin(35.0 * 3.14159265358979323846 / 180.0)));
  }
}

TEST_CASE("what stands on the floor stands upright in the picture") {
  // A tall box: it stands on its small face along y and along z alike; y is the custom. Lying along z it stands on a
  // broad face either way.
  Scene scene;
  choose_camera(scene, splats_of(BoxShape{Vector3d(0, 0, 0), Vector3d(1, 3, 1), false}, 0.1));
  CHECK(up_of(scene).y() > 0.9);
}

TEST_CASE("the scene's up wins for every kind of cloud, the file's before what is found") {
  for (const CloudKind kind : {CloudKind::model, CloudKind::depth_frame, CloudKind::station, CloudKind::terrain,
                               CloudKind::room, CloudKind::map, CloudKind::sparse, CloudKind::foliage})
    for (const UpAxis up : up_axes()) {
      PointCloud cloud = vase();
      for (Vector3d& p : cloud.position)
        p += Vector3d(1.0, 2.0, 3.0);
      WorldSplats splats = of_kind(std::move(cloud), kind);
      Scene scene;
      splats.reports[0].up = Vector3d(-1, 0, 0);
      CHECK((choose_camera(scene, splats).up + Vector3d::UnitX()).norm() < 1e-12);
      scene.up = up;
      scene.up_chosen = true;
      scene.camera.up.reset();
      CHECK((choose_camera(scene, splats).up - direction_of(up)).norm() == 0.0);
      CHECK(up_of(scene).dot(direction_of(up)) > 0.99);
    }
}

TEST_CASE("a depth frame is seen from its sensor, a station from behind and above") {
  PointCloud wall = shape(QuadShape{{5, -2, -1}, {0, 0, 3}, {0, 4, 0}}, 0.1); // faces the origin
  WorldSplats splats = of_kind(wall, CloudKind::depth_frame);
  Scene scene;
  choose_camera(scene, splats);
  CHECK(scene.camera.position.norm() == 0.0);
  splats = of_kind(wall, CloudKind::station);
  splats.reports[0].stations = {Vector3d(0, 0, 0)};
  scene = Scene();
  choose_camera(scene, splats);
  CHECK(scene.camera.position.x() < 5.0);
  CHECK(view_of(scene).x() > 0.5);
  CHECK(view_of(scene).z() < -0.3);
}

TEST_CASE("a room is seen from outside, through its near walls, and has lamps inside") {
  WorldSplats splats = splats_of(z_up(box({0, 0, 0}, {3, 1, 2.5}, true)));
  Scene scene;
  const ChosenView view = choose_camera(scene, splats);
  CHECK(view.kind == CloudKind::room);
  CHECK(view.up.z() == 1.0);
  REQUIRE(view.is_closed_room);
  CHECK(scene.camera.backfaces == Backfaces::see_through);
  CHECK(scene.camera.position.z() > 1.0);
  choose_lights(scene, splats, view);
  REQUIRE(!scene.lights.empty());
  for (const LightSettings& lamp : scene.lights) {
    CHECK((lamp.vector.array() > Eigen::Array3d(0.0, -2.5, 0.0)).all());
    CHECK((lamp.vector.array() < Eigen::Array3d(3.0, 0.0, 1.0)).all());
  }
  scene = Scene();
  scene.camera.backfaces = Backfaces::shade;
  choose_camera(scene, splats);
  CHECK(scene.camera.backfaces == Backfaces::shade);
}

TEST_CASE("the ground lies below what stands free, level, and as bright as the background") {
  for (const bool is_z_up : {false, true}) {
    PointCloud cloud = is_z_up ? z_up(goblet()) : goblet();
    WorldSplats splats = splats_of(std::move(cloud));
    const std::size_t count = splats.cloud.size();
    Scene scene;
    scene.ground = true;
    const ChosenView view = choose_camera(scene, splats);
    choose_lights(scene, splats, view);
    REQUIRE(splats.cloud.size() > count);
    CHECK(splats.cloud.size() < count + 6000); // next to nothing beside a scan
    CHECK(splats.first.back() == count);
    double area = 0.0, farthest = 0.0;
    for (std::size_t i = count; i < splats.cloud.size(); ++i) {
      CHECK(std::fabs(view.up.dot(splats.cloud.position[i])) < 0.01);
      area += splats.cloud.area[i];
      farthest = std::max(farthest, splats.cloud.position[i].norm());
    }
    // Rings of cells: the outermost reaches half its width beyond its splats, a twentieth of the radius at most.
    CHECK(area / (3.14159265358979323846 * farthest * farthest) == Approx(1.1).margin(0.15));
    // A level surface far from the object receives the sun and the whole sky.
    const LightSettings& sun = scene.lights.at(0);
    const Vector3d irradiance = sun.strength * sun.vector.dot(view.up) + 3.14159265358979323846 * scene.environment;
    const Vector3d radiance = scene.materials.back().albedo->cwiseProduct(irradiance) / 3.14159265358979323846;
    CHECK((radiance - scene.environment).norm() < 1e-12);
    CHECK(irradiance.y() == Approx(3.14159265358979323846));
  }
}

TEST_CASE("what brings its own ground, and what is open, gets none") {
  PointCloud with_floor = statue();
  add(with_floor, shape(QuadShape{{-0.7, 0, -0.7}, {0, 0, 1.4}, {1.4, 0, 0}}, 0.05));
  for (const PointCloud& cloud : {with_floor, shape(QuadShape{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0.02)}) {
    WorldSplats splats = splats_of(cloud);
    const std::size_t count = splats.cloud.size();
    Scene scene;
    scene.ground = true;
    choose_lights(scene, splats, choose_camera(scene, splats));
    CHECK(splats.cloud.size() == count);
    CHECK(!scene.lights.empty());
  }
}
