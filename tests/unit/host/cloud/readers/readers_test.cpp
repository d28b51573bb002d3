/// Which file is read by whom.
#include "host/cloud/readers/readers.h"
#include "host/error.h"
#include "tests/support/gaussian_bytes.h"
#include "tests/support/laz_bytes.h"
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

TEST_CASE("a format that is not read is named, with what to do", "[readers]") {
  const TemporaryFolder folder;
  CloudReport report;
  CHECK_THROWS_WITH(read_cloud(folder.write("scan.ply.gz", "\x1f\x8b"), {}, report), Contains("unpack it first"));
  CHECK_THROWS_WITH(read_cloud(folder.write("scan.FLS", "?"), {}, report),
                    Contains("scan of FARO is not read directly") && Contains("export it as E57"));
  CHECK_THROWS_WITH(read_cloud(folder.file("none.e57"), {}, report), Contains("cannot read the file"));
}

TEST_CASE("what a file holds decides where its name says something else", "[readers]") {
  const TemporaryFolder folder;
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
                          "z\nend_header\n1 2 3\n";
  for (const char* name : {"a.las", "a.xyz", "a.obj", "a"}) {
    INFO(name);
    CloudReport report;
    CHECK(read_cloud(folder.write(name, ply), {}, report).size() == 1);
  }
  const LazSample& sample = laz_samples().front();
  for (const char* name : {"b.las", "b.laz", "b.ply", "b"})
    for (const bool compressed : {false, true}) {
      INFO(name << ", compressed: " << compressed);
      CloudReport report;
      CHECK(read_cloud(folder.write(name, laz_file(sample, compressed)), {}, report).size() == laz_points);
    }
  CloudReport report;
  CHECK_THROWS_WITH(read_cloud(folder.write("b.ply", "ASTM-E57 and more"), {}, report),
                    Contains("the file ends within its header"));
}

TEST_CASE("text, grids, Gaussians and packed files are told apart by what they hold", "[readers]") {
  const TemporaryFolder folder;
  const auto format_of = [&](const char* name, const std::string& bytes) {
    CloudReport report;
    read_cloud(folder.write(name, bytes), {}, report);
    return report.format;
  };
  const std::string grid = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n";
  const std::vector<TestGaussian> gaussians = some_gaussians(3);
  for (const char* name : {"a.txt", "a.ptx", "a", "a.dat"})
    CHECK(format_of(name, grid) == "PTX");
  for (const char* name : {"b.XYZ", "b.csv", "b.asc", "b", "b.dat", "b.ply"})
    CHECK(format_of(name, "1 2 3\n4 5 6\n") == "text");
  CHECK(format_of("c.pts", "1\n1 2 3\n") == "PTS");
  for (const char* name : {"d.spz", "d", "d.ply"})
    CHECK(format_of(name, spz_bytes(gaussians, 3, 0)) == "SPZ version 3");
  for (const char* name : {"e.compressed.ply", "e.ply", "e"})
    CHECK(format_of(name, compressed_ply_bytes(gaussians, true, false)).find("compressed Gaussians") == 0);
  CHECK(format_of("f.SPLAT", splat_bytes(gaussians)) == "splat");
  // A mesh is one, numbers or not.
  CHECK(format_of("g.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").find("mesh") == 0);
  for (const char* name : {"h", "h.ply", "h.xyz"})
    CHECK_THROWS_WITH(format_of(name, gzipped("1 2 3\n")), Contains("a packed file") && Contains("unpack it first"));
}
