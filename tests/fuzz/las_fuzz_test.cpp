/// Damaged LAS files: whatever the bytes, read_las() returns a cloud that the file can account for or throws an input
/// error that says where.
#include "host/cloud/readers/las_read.h"
#include "host/cloud/readers/las_write.h"
#include "host/error.h"
#include "tests/support/las_bytes.h"
#include "tests/support/mutator.h"
#include "tests/support/survives.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Small files with everything that the reader knows: old and new formats, records before and behind the points.
std::vector<std::string> seed_files() {
  std::vector<std::string> seeds;
  for (const unsigned format : {0u, 3u, 8u}) {
    LasFile file;
    file.format = format;
    file.minor = format < 8 ? 2 : 4;
    const std::string entries = las_extra_entry_bytes("Deviation", 4, 24, {0.5, 0, 0}, {1, 0, 0}) +
                                las_extra_entry_bytes("Triple", 29) + las_extra_entry_bytes("Raw", 0, 2);
    std::string keys;
    for (const std::uint16_t number : std::array<std::uint16_t, 8>{1, 1, 0, 1, 1024, 0, 1, 2})
      keys += bytes_of(number);
    file.vlrs = {las_vlr("LASF_Projection", 34735, keys)};
    (format < 8 ? file.vlrs : file.evlrs).push_back(las_vlr("LASF_Spec", 4, entries, format == 8));
    for (std::uint16_t i = 0; i < 6; ++i) {
      LasPoint p;
      p.position = {i, -i, 3 * i};
      p.colour = {i, 2, 40000};
      file.points.push_back(p);
      file.extra.push_back(std::string(2 + 12 + 2 + 1, static_cast<char>(i)));
    }
    seeds.push_back(file.bytes());
  }
  return seeds;
}

/// A point takes 20 bytes at least.
bool is_cloud(const std::string& path, std::size_t file_size) {
  return survives(read_las, path, file_size, 20);
}

} // namespace

TEST_CASE("las fuzz: truncation at every byte") {
  const TemporaryFolder folder;
  for (const std::string& seed : seed_files()) {
    CHECK(is_cloud(folder.write("whole.las", seed), seed.size()));
    std::size_t clouds = 0;
    for (std::size_t length = 0; length < seed.size(); ++length) {
      INFO("length " << length);
      clouds += is_cloud(folder.write("cut.las", seed.substr(0, length)), length);
    }
    CHECK(clouds < seed.size() / 2); // only what lies behind the points is spare
  }
}

TEST_CASE("las fuzz: thousands of mutations, and what is read can be written with columns") {
  const TemporaryFolder folder;
  std::uint32_t number = 0;
  for (const std::string& seed : seed_files()) {
    std::size_t clouds = 0;
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t random_seed = ++number;
      INFO("mutation " << random_seed);
      const std::string bytes = Mutator(random_seed)(seed);
      const std::string path = folder.write("mutated.las", bytes);
      if (!is_cloud(path, bytes.size())) continue;
      ++clouds;
      if (i % 4 != 0) continue; // disks are slow
      CloudReport report;
      const std::size_t points = read_las(path, {}, report).size();
      try {
        write_las_with_columns(path, folder.file("out.las"),
                               {{{"c", FieldType::u16, 1.0, 0.0}, std::vector<double>(points, 7.0)}},
                               std::vector<Eigen::Vector3f>(points, Eigen::Vector3f::Ones()));
        CloudReport again;
        const PointCloud cloud = read_las(folder.file("out.las"), {0.0, {}, true}, again);
        REQUIRE(cloud.size() == points);
        REQUIRE(cloud.fields.back().values == std::vector<double>(points, 7.0));
      } catch (const Error& error) { // no room for more
        INFO(error.what());
        REQUIRE(error.kind() == ErrorKind::input);
      }
    }
    // Both outcomes must have been met, else the fuzz tests one half of the reader only.
    CHECK(clouds > 20);
    CHECK(clouds < 1980);
  }
}
