#include "host/scene/splats.h"
#include "tests/support/las_bytes.h"
#include "tests/unit/host/scene/scene_files.h"
#include <catch2/catch.hpp>
#include <numeric>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("splats: a cloud in degrees is one in metres, as is its viewpoint") {
  LasFile file;
  file.scale = {1e-7, 1e-7, 0.01};
  for (int i = 0; i < 400; ++i) { // 20 x 20 points, 0.001 degrees apart at 45 degrees of latitude, 500 m high
    LasPoint p;
    p.position = {100000000 + 10000 * (i % 20), 450000000 + 10000 * (i / 20), 50000 + i % 3};
    file.points.push_back(p);
  }
  std::string keys;
  for (const std::uint16_t number : std::array<std::uint16_t, 8>{1, 1, 0, 1, 1024, 0, 1, 2})
    keys += bytes_of(number);
  file.vlrs = {las_vlr("LASF_Projection", 34735, keys)};
  const SceneFolder folder;
  folder.write("degrees.las", file.bytes());
  // Underground: only the viewpoint turns normals down.
  const WorldSplats splats = load_splats(
      folder.load("version = 1\n[[material]]\nname = \"stone\"\ntype = \"diffuse\"\n[[cloud]]\nfile = \"degrees.las\"\n"
                  "material = \"stone\"\nnormals = \"estimate\"\nviewpoint = [10.01, 45.01, -1000.0]\n"));
  const PointCloud& cloud = splats.cloud;
  REQUIRE(cloud.size() == 400);
  REQUIRE(splats.reports.at(0).placement.has_value());
  Eigen::Vector3d low = cloud.position[0], high = low;
  for (const Eigen::Vector3d& p : cloud.position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // WGS 84 at 45 degrees: 78847 and 111132 metres a degree.
  CHECK(high.x() - low.x() == Approx(0.019 * 78847).epsilon(1e-3));
  CHECK(high.y() - low.y() == Approx(0.019 * 111132).epsilon(1e-3));
  CHECK(high.z() == Approx(500.02));
  const double area = std::accumulate(cloud.area.begin(), cloud.area.end(), 0.0);
  // The rim's cells are whole: 20 by 20 of them.
  CHECK(area == Approx(0.020 * 78847 * 0.020 * 111132).epsilon(0.1));
  for (const Eigen::Vector3f& normal : cloud.normal)
    CHECK(normal.z() < -0.9f);
}
