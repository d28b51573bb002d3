#include "host/cloud/readers/ply.h"
#include "tests/support/scans.h"
#include "tests/unit/host/cloud/completed_cloud.h"
#include "tests/unit/host/cloud/sampled_surfaces.h"

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

double mesh_area(const PointCloud& cloud) {
  double area = 0;
  for (const auto& t : cloud.triangle)
    area += (cloud.position[t[1]] - cloud.position[t[0]]).cross(cloud.position[t[2]] - cloud.position[t[0]]).norm() / 2;
  return area;
}

/// A third of the sum of A n.x: the volume that the normals and areas enclose.
double splat_volume(const PointCloud& cloud) {
  double volume = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    volume += static_cast<double>(cloud.area[i]) * cloud.normal[i].cast<double>().dot(cloud.position[i]) / 3;
  return volume;
}

std::optional<PointCloud> scan(const std::string& name) {
  const auto path = scan_path(name);
  if (!path) {
    WARN("skipped: no scan " + name);
    return std::nullopt;
  }
  CloudReport report;
  return read_ply(*path, {}, report);
}

} // namespace

TEST_CASE("bunny: faces with holes, and points in no face", "[cloud][complete][scans]") {
  auto cloud = scan("bunny.ply");
  if (!cloud) return;
  const CloudReport report = complete(*cloud);
  check_promises(*cloud);
  CHECK(report.normals_from == "faces");
  CHECK(warns_of(report, "1113 of ")); // of the vertices, some of which are several points at edges
  // Cells reach half a spacing over the rims of its holes, and the points in no face stand for surface that no triangle
  // has: measured +1.7 %.
  CHECK(total(cloud->area) == Approx(mesh_area(*cloud)).epsilon(0.03));
  CHECK(splat_volume(*cloud) > 0);
}

TEST_CASE("horse: normals and winding point inwards", "[cloud][complete][scans]") {
  auto cloud = scan("horse.ply");
  if (!cloud) return;
  CHECK(mesh_volume(*cloud) < 0);
  const double volume = -mesh_volume(*cloud);
  const CloudReport report = complete(*cloud);
  check_promises(*cloud);
  CHECK(report.normals_from == "file, flipped");
  CHECK(mesh_volume(*cloud) == Approx(volume));
  CHECK(splat_volume(*cloud) == Approx(volume).epsilon(0.02));          // splats are as large as the mesh, to 1 %
  CHECK(total(cloud->area) == Approx(mesh_area(*cloud)).epsilon(0.01)); // even and closed; measured 0.05 %

  // Its points alone: estimated normals agree with the mesh's.
  PointCloud bare;
  bare.position = cloud->position;
  CompleteOptions shrunk;
  shrunk.strays = StrayPolicy::shrink;
  CHECK(complete(bare, shrunk).normals_from == "estimated (outwards)");
  CHECK(agreement(bare, cloud->normal) > 0.99); // the ears are thinner than their spacing
}

TEST_CASE("kinect: a depth image from the origin", "[cloud][complete][scans][long]") {
  auto cloud = scan("kinect_region_growing_rgb.ply");
  if (!cloud) return;
  CHECK(complete(*cloud).normals_from == "estimated (towards the sensor at the origin)");
  check_promises(*cloud);
  std::size_t away = 0;
  for (std::size_t i = 0; i < cloud->size(); ++i)
    away += cloud->normal[i].cast<double>().dot(cloud->position[i].normalized()) > 1e-5; // float, seen edge on
  CHECK(away == 0);
}

TEST_CASE("autzen: airborne lidar faces upwards", "[cloud][complete][scans]") {
  auto cloud = scan("autzen_trim.ply");
  if (!cloud) return;
  CHECK(complete(*cloud).normals_from == "estimated (upwards along z)");
  check_promises(*cloud);
  const auto up =
      std::count_if(cloud->normal.begin(), cloud->normal.end(), [](const Vector3f& n) { return n.z() > 0; });
  CHECK(static_cast<double>(up) / static_cast<double>(cloud->size()) > 0.9); // measured 0.93; crowns of trees lean
}

TEST_CASE("pond and lion: open scans keep their normals", "[cloud][complete][scans][long]") {
  for (const std::string name : {"pond.ply", "lion_takanawa.ply"}) {
    auto cloud = scan(name);
    if (!cloud) continue;
    const std::vector<Vector3f> given = cloud->normal;
    CompleteOptions options;
    options.strays = StrayPolicy::keep; // both have some
    CHECK(complete(*cloud, options).normals_from == "file");
    check_promises(*cloud);
    REQUIRE(cloud->size() == given.size());
    CHECK(agreement(*cloud, given) == 1);
  }
}
