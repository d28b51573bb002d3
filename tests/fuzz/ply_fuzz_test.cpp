/// Damaged PLY files: whatever the bytes, read_ply() returns a cloud that the file can account for or throws an input
/// error that says where.
#include "host/cloud/readers/ply.h"
#include "host/error.h"
#include "tests/support/mutator.h"
#include "tests/support/ply_bytes.h"
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace pointgi;
using pointgi::test::bytes_of;
using pointgi::test::contents;
using pointgi::test::Mutator;
using pointgi::test::TemporaryFolder;

namespace {

/// Small files with lists in vertices, faces and strips, one a format.
std::vector<std::string> seeds_with_lists() {
  const std::string rest = " 1.0\ncomment seed\nobj_info none\nelement vertex 4\nproperty float x\nproperty double y\n"
                           "property short z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                           "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float radius\n"
                           "property list uchar ushort neighbours\nelement face 2\nproperty uchar flags\n"
                           "property list uchar int vertex_indices\nproperty list int float texcoord\n"
                           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  std::string ascii = "ply\nformat ascii" + rest;
  for (int i = 0; i < 4; ++i)
    ascii += std::to_string(i) + ".5 -1e3 7 0 0.6 0.8 255 128 0 0.01 2 1 3\n";
  ascii += "1 3 0 1 2 2 0.5 0.25\n0 4 0 1 2 3 0\n6 0 1 2 -1 1 3\n";
  std::vector<std::string> seeds{ascii};
  for (const bool big : {false, true}) {
    std::string binary = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") + rest;
    for (int i = 0; i < 4; ++i) {
      binary += bytes_of(static_cast<float>(i) + 0.5f, big) + bytes_of(-1e3, big) + bytes_of<std::int16_t>(7, big);
      for (const float n : {0.0f, 0.6f, 0.8f})
        binary += bytes_of(n, big);
      binary += std::string("\xff\x80\0", 3) + bytes_of(0.01f, big);
      binary += "\2" + bytes_of<std::uint16_t>(1, big) + bytes_of<std::uint16_t>(3, big);
    }
    binary += "\1\3";
    for (const int index : {0, 1, 2})
      binary += bytes_of<std::int32_t>(index, big);
    binary += bytes_of<std::int32_t>(1, big) + bytes_of(0.5f, big) + std::string("\0\4", 2);
    for (const int index : {0, 1, 2, 3})
      binary += bytes_of<std::int32_t>(index, big);
    binary += bytes_of<std::int32_t>(0, big) + bytes_of<std::int32_t>(6, big);
    for (const int index : {0, 1, 2, -1, 1, 3})
      binary += bytes_of<std::int32_t>(index, big);
    seeds.push_back(binary);
  }
  return seeds;
}

/// Small files of vertices of one length, with stations before and faces with colours behind them, one a format.
std::vector<std::string> seeds_of_fixed_length() {
  const std::string rest =
      " 1.0\ncomment pointgi up z\nelement station 2\nproperty double x\nproperty double y\nproperty double z\n"
      "element camera 1\nproperty float focal\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float normalx\nproperty float normaly\nproperty float normalz\nproperty float scalar_Intensity\n"
      "property ushort station\nproperty double time\nelement face 4\nproperty list uchar int vertex_indices\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  std::string ascii = "ply\nformat ascii" + rest + "0 0 1\n1 1 1\n35\n";
  for (int i = 0; i < 4; ++i)
    ascii += std::to_string(i) + ".5 -1 7 0 0.6 0.8 17 1 1e9\n";
  for (int i = 0; i < 4; ++i)
    ascii += "3 0 1 2 9 8 7\n";
  std::vector<std::string> seeds{ascii};
  for (const bool big : {false, true}) {
    std::string binary = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") + rest;
    for (const double value : {0.0, 0.0, 1.0, 1.0, 1.0, 1.0})
      binary += bytes_of(value, big);
    binary += bytes_of(35.0f, big);
    for (int i = 0; i < 4; ++i) {
      for (const float value : {static_cast<float>(i), -1.0f, 7.0f, 0.0f, 0.6f, 0.8f, 17.0f})
        binary += bytes_of(value, big);
      binary += bytes_of<std::uint16_t>(1, big) + bytes_of(1e9, big);
    }
    for (int i = 0; i < 4; ++i)
      binary += "\3" + bytes_of<std::int32_t>(0, big) + bytes_of<std::int32_t>(1, big) +
                bytes_of<std::int32_t>(2, big) + "\xbe\x50\x32";
    seeds.push_back(binary);
  }
  return seeds;
}

std::vector<std::string> seed_files() {
  std::vector<std::string> seeds = seeds_with_lists();
  for (const std::string& seed : seeds_of_fixed_length())
    seeds.push_back(seed);
  return seeds;
}

/// Reads the file; fails the test unless the outcome is one of the two that are allowed. True when it was a cloud.
bool survives(const std::string& path, std::size_t file_size) {
  CloudReport report;
  try {
    const PointCloud cloud = read_ply(path, {}, report);
    // A vertex takes three bytes at least; a triangle comes with an index of a byte or more of its own.
    REQUIRE(cloud.size() <= file_size / 3);
    REQUIRE(cloud.triangle.size() <= file_size);
    // Space is asked for by counts that were checked, and growth doubles it at most.
    REQUIRE(cloud.position.capacity() <= file_size / 3);
    REQUIRE(cloud.triangle.capacity() <= 2 * file_size);
    for (const auto& corners : cloud.triangle)
      for (const std::uint32_t corner : corners)
        REQUIRE(corner < cloud.size());
    for (const std::size_t length :
         {cloud.normal.size(), cloud.colour.size(), cloud.radius.size(), cloud.station.size()})
      REQUIRE((length == 0 || length == cloud.size()));
    REQUIRE(report.points_in_file == cloud.size());
    REQUIRE(report.triangles == cloud.triangle.size());
    return true;
  } catch (const Error& error) {
    const std::string text = error.what();
    INFO(text);
    REQUIRE(error.kind() == ErrorKind::input);
    REQUIRE(text.find(path) == 0);
    REQUIRE((text.find(": line ") != std::string::npos || text.find(": byte ") != std::string::npos));
    // Fit for a terminal: nothing of the file's bytes as they are.
    REQUIRE(std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    REQUIRE(text.size() < 1000);
    return false;
  }
}

} // namespace

TEST_CASE("ply fuzz: the seeds themselves are sound") {
  const TemporaryFolder folder;
  for (const std::string& seed : seed_files()) {
    CloudReport report;
    const PointCloud cloud = read_ply(folder.write("seed.ply", seed), {}, report);
    CHECK(cloud.size() == 4);
    CHECK(cloud.triangle.size() == 4); // or a triangle, a quad, and a strip of one (the second strip is too short)
    CHECK(report.warnings.empty());
  }
}

TEST_CASE("ply fuzz: truncation at every byte") {
  const TemporaryFolder folder;
  for (const std::string& seed : seed_files()) {
    const bool ascii = seed.find("format ascii") != std::string::npos;
    for (std::size_t length = 0; length < seed.size(); ++length) {
      INFO("length " << length);
      const bool cloud = survives(folder.write("cut.ply", seed.substr(0, length)), length);
      // Text is complete without its last line end; a byte of a binary file is never spare.
      CHECK(cloud == (ascii && length + 1 == seed.size()));
    }
  }
}

TEST_CASE("ply fuzz: thousands of mutations") {
  const TemporaryFolder folder;
  std::uint32_t number = 0;
  for (const std::string& seed : seed_files()) {
    std::size_t clouds = 0;
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t random_seed = ++number;
      INFO("mutation " << random_seed);
      const std::string bytes = Mutator(random_seed)(seed);
      clouds += survives(folder.write("mutated.ply", bytes), bytes.size());
    }
    // Both outcomes must have been met, else the fuzz tests one half of the reader only.
    CHECK(clouds > 20);
    CHECK(clouds < 1980);
  }
}

TEST_CASE("ply fuzz: the samples by which other projects test their readers") {
  const auto samples = test::scan_path("parser");
  if (!samples) {
    WARN("skipped: no folder parser among the scans");
    return;
  }
  // Without points, without z, with no header to speak of, or with fewer columns than declared.
  const std::vector<std::string> refused{"PDAL__sized_dims.ply",
                                         "PDAL__unsized_dims.ply",
                                         "assimp__crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
                                         "assimp__empty.ply",
                                         "assimp__issue623.ply",
                                         "trimesh__empty.ply",
                                         "trimesh__emptyIO_ply_empty_bin.ply"};
  const TemporaryFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(*samples)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".ply") continue;
    INFO(name);
    const std::size_t size = static_cast<std::size_t>(entry.file_size());
    CHECK(survives(entry.path().string(), size) == (std::find(refused.begin(), refused.end(), name) == refused.end()));
    if (size > 100000) continue;
    // And each damaged a little, as a download might be.
    const std::string bytes = contents(entry.path().string());
    for (std::uint32_t i = 0; i < 30; ++i) {
      INFO("mutation " << i);
      const std::string damaged = Mutator(i)(bytes);
      survives(folder.write("damaged.ply", damaged), damaged.size());
    }
  }
}
