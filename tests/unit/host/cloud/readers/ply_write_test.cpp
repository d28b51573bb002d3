#include "host/cloud/readers/ply.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <limits>

using namespace pointgi;
using Catch::Matchers::Contains;
using pointgi::test::contents;
using pointgi::test::TemporaryFolder;

namespace {

/// Map coordinates with millimetres, and every attribute a file can carry.
PointCloud sample_cloud() {
  PointCloud cloud;
  cloud.position = {{636001.001, 848935.002, 406.003}, {636001.002, 848935.001, 406.004}, {-1e300, 5e-324, 0.1}};
  cloud.normal = {{0, 0, 1}, {0.6f, 0, -0.8f}, {1e-3f, 2, 3}};
  cloud.colour = {{0, 0.5f, 1}, {10 / 255.0f, 20 / 255.0f, 30 / 255.0f}, {1, 1, 1}};
  cloud.radius = {0.5f, 1e-20f, 3.0f};
  cloud.triangle = {{0, 1, 2}, {2, 1, 0}};
  return cloud;
}

} // namespace

TEST_CASE("ply write: what is written is read back") {
  TemporaryFolder folder;
  const PointCloud cloud = sample_cloud();
  write_ply(folder.file("a.ply"), cloud);
  CHECK(folder.entries() == 1);
  CloudReport report;
  const PointCloud back = read_ply(folder.file("a.ply"), {}, report);
  CHECK(report.format == "PLY 1.0 binary_little_endian");
  CHECK(report.warnings.empty());
  CHECK(back.position == cloud.position); // doubles: bit for bit
  CHECK(back.normal == cloud.normal);
  CHECK(back.radius == cloud.radius);
  CHECK(back.triangle == cloud.triangle);
  REQUIRE(back.colour.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    // Half of a byte's step, and the rounding of the division by 255.
    CHECK((back.colour[i] - cloud.colour[i]).cwiseAbs().maxCoeff() <= 0.5f / 255.0f + 1e-6f);
  CHECK(back.colour[1].x() == Approx(10 / 255.0).epsilon(1e-6)); // whole bytes survive to float rounding
}

TEST_CASE("ply write: columns follow under their names and missing attributes are not written") {
  TemporaryFolder folder;
  PointCloud cloud;
  cloud.position = {{1, 2, 3}, {4, 5, 6}};
  write_ply(folder.file("a.ply"), cloud, {{"scalar_radiosity_r", {0.25f, 7.0f}}, {"b", {1.0f, 2.0f}}});
  const std::string text = contents(folder.file("a.ply"));
  CHECK_THAT(text, Contains("property double z\nproperty float scalar_radiosity_r\nproperty float b\nend_header\n"));
  // 3 doubles and 2 floats a point
  CHECK(text.size() == text.find("end_header\n") + 11 + 2 * (24 + 8));
  CloudReport report;
  const PointCloud back = read_ply(folder.file("a.ply"), {}, report);
  CHECK(back.position == cloud.position);
  CHECK(back.normal.empty());
  CHECK(back.colour.empty());
  CHECK(back.radius.empty());
  REQUIRE(report.properties.size() == 5);
  CHECK(report.properties[3].property == "vertex.scalar_radiosity_r (float)");
  CHECK(report.properties[3].use == "not used");
}

TEST_CASE("ply write: colours that are no colours become bytes without a surprise") {
  TemporaryFolder folder;
  PointCloud cloud;
  cloud.position = {{0, 0, 0}};
  cloud.colour = {{std::numeric_limits<float>::quiet_NaN(), -3.0f, std::numeric_limits<float>::infinity()}};
  write_ply(folder.file("a.ply"), cloud);
  CloudReport report;
  CHECK(read_ply(folder.file("a.ply"), {}, report).colour[0] == Eigen::Vector3f(0, 0, 1));
}

TEST_CASE("ply write: more than one buffer full") {
  TemporaryFolder folder;
  PointCloud cloud;
  for (int i = 0; i < 200000; ++i) // 4.8 MB of positions
    cloud.position.emplace_back(i, -i, 0.5 * i);
  write_ply(folder.file("a.ply"), cloud);
  CloudReport report;
  CHECK(read_ply(folder.file("a.ply"), {}, report).position == cloud.position);
}

TEST_CASE("ply write: a place that cannot be written is an output error and the old file stays whole") {
  TemporaryFolder folder;
  const PointCloud cloud = sample_cloud();
  for (const std::string& path : {folder.file("missing/a.ply"), std::string("/dev/full"), folder.file("")}) {
    try {
      write_ply(path, cloud);
      FAIL("written: " << path);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::output);
      CHECK_THAT(error.what(), Contains(path));
    }
  }
  // A fault in the middle of the work: nothing of it may reach the file.
  const std::string path = folder.write("a.ply", "old");
  CHECK_THROWS_AS(write_ply(path, cloud, {{"short", {1.0f}}}), Error);
  CHECK_THROWS_AS(write_ply(path, cloud, {{"two words", {1.0f, 2.0f, 3.0f}}}), Error);
  CHECK(contents(path) == "old");
  CHECK(folder.entries() == 1);
}
