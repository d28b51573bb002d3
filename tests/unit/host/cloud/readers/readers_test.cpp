/// Which file is read by whom.
#include "host/cloud/readers/readers.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

TEST_CASE("each extension has one reader", "[readers]") {
  std::set<std::string> seen;
  for (const CloudReader& reader : cloud_readers())
    for (const std::string& extension : reader.extensions)
      CHECK(seen.insert(extension).second);
  CHECK(seen.count(".ply") == 1);
}

TEST_CASE("a file is read by its extension, whatever its case", "[readers]") {
  const TemporaryFolder folder;
  const std::string one_point = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                                "float z\nend_header\n1 2 3\n";
  for (const char* name : {"a.ply", "b.PLY"}) {
    CloudReport report;
    const PointCloud cloud = read_cloud(folder.write(name, one_point), {}, report);
    REQUIRE(cloud.size() == 1);
    CHECK(cloud.position[0] == Eigen::Vector3d(1, 2, 3));
  }
  CloudReport report;
  const PointCloud mesh = read_cloud(folder.write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {0.1, {}, false},
                                     report); // half a unit of area
  CHECK(mesh.size() > 40);
  CHECK(mesh.size() < 60);
}

TEST_CASE("a scanner's own format is named, with what to do", "[readers]") {
  CloudReport report;
  for (const char* name : {"scan.las", "scan.E57"})
    CHECK_THROWS_WITH(read_cloud(name, {}, report),
                      Contains(name) && Contains("is not read directly") && Contains("convert it to PLY"));
}
