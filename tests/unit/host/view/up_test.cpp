#include "host/view/up.h"
#include "tests/unit/host/view/shapes.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

Vector3d up_of_model(const PointCloud& cloud) {
  return find_up(view_points(cloud, 0.005), CloudKind::model, Vector3d::Zero()).up;
}

/// A floor, and a wall behind it, as a camera at the origin sees them that looks along `forward`.
PointCloud frame_of_camera(const Vector3d& forward, const Vector3d& up) {
  const Vector3d right = forward.cross(up);
  const Vector3d corner = 1.0 * forward - 1.0 * right - 0.8 * up;
  PointCloud cloud;
  for (double a = 0.025; a < 2.0; a += 0.05)
    for (double b = 0.025; b < 2.0; b += 0.05)
      cloud.position.push_back(corner + a * forward + b * right);
  cloud.normal.assign(cloud.position.size(), up.cast<float>());
  cloud.radius.assign(cloud.position.size(), 0.04f);
  cloud.area.assign(cloud.position.size(), 0.0025f);
  PointCloud wall = cloud;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const Vector3d d = cloud.position[i] - corner;
    wall.position[i] = corner + 2.0 * forward + d.dot(right) * right + 0.8 * d.dot(forward) * up;
    wall.normal[i] = (-forward).cast<float>();
  }
  add(cloud, wall);
  return cloud;
}

} // namespace

TEST_CASE("what stands is upright, whether its file has y or z upwards, and however wide it is above") {
  for (const PointCloud& cloud : {goblet(), vase(), statue(), chair()}) {
    CHECK((up_of_model(cloud) - Vector3d::UnitY()).norm() == 0.0);
    CHECK((up_of_model(z_up(cloud)) - Vector3d::UnitZ()).norm() == 0.0);
  }
}

TEST_CASE("a tree stands along its trunk, with nothing to stand on") {
  CHECK((up_of_model(tree()) - Vector3d::UnitY()).norm() == 0.0);
  CHECK((up_of_model(z_up(tree())) - Vector3d::UnitZ()).norm() == 0.0);
  const UpChoice foliage = find_up(view_points(z_up(tree()), 0.005), CloudKind::foliage, Vector3d::Zero());
  CHECK(foliage.up.z() == 1.0);
}

TEST_CASE("what stands on a slab in a file with y downwards is turned round") {
  CHECK((up_of_model(upside_down(statue())) + Vector3d::UnitY()).norm() == 0.0);
}

TEST_CASE("what a format is used to is up for sparse points, and for models without a broad flat foot") {
  const std::optional<Vector3d> usual = Vector3d(-Vector3d::UnitY());
  const auto up_of = [&](const PointCloud& cloud, CloudKind kind) {
    return find_up(view_points(cloud, 0.005), kind, Vector3d::Zero(), usual).up;
  };
  CHECK(up_of(tree(), CloudKind::foliage).y() == -1.0);
  CHECK(up_of(vase(), CloudKind::sparse).y() == -1.0);
  CHECK(up_of(vase(), CloudKind::model).y() == 1.0);
  CHECK(up_of(z_up(vase()), CloudKind::model).z() == 1.0);
}

TEST_CASE("a room is level across its floor") {
  PointCloud room = box({0, 0, 0}, {3, 1, 2.5}, true);
  CHECK(find_up(view_points(room, 0.005), CloudKind::room, Vector3d::Zero()).up.y() == 1.0);
  CHECK(find_up(view_points(z_up(room), 0.005), CloudKind::room, Vector3d::Zero()).up.z() == 1.0);
}

TEST_CASE("terrain is level across its thin axis, on the side that it faces") {
  PointCloud field = shape(QuadShape{{0, 0, 0}, {5, 0, 0}, {0, 4, 0}}, 0.1);
  CHECK(find_up(view_points(field, 0.005), CloudKind::terrain, Vector3d::Zero()).up.z() == 1.0);
  for (auto& n : field.normal)
    n = -n;
  CHECK(find_up(view_points(field, 0.005), CloudKind::terrain, Vector3d::Zero()).up.z() == -1.0);
}

TEST_CASE("a depth frame has its floor below the camera, whichever way its y runs") {
  for (const double z : {1.0, -1.0})
    for (const double y : {1.0, -1.0}) {
      const PointCloud cloud = frame_of_camera(z * Vector3d::UnitZ(), y * Vector3d::UnitY());
      CHECK(find_up(view_points(cloud, 0.005), CloudKind::depth_frame, Vector3d::Zero()).up.y() == y);
    }
  const PointCloud scanned = frame_of_camera(Vector3d::UnitX(), Vector3d::UnitZ());
  CHECK(find_up(view_points(scanned, 0.005), CloudKind::depth_frame, Vector3d::Zero()).up.z() == 1.0);
}

TEST_CASE("scans of stations and maps have z upwards") {
  for (const CloudKind kind : {CloudKind::station, CloudKind::map})
    CHECK(find_up(view_points(vase(), 0.005), kind, Vector3d::Zero()).up.z() == 1.0);
}
