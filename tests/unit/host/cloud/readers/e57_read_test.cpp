#include "host/cloud/readers/e57_read.h"
#include "host/error.h"
#include "tests/support/e57_bytes.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// One scan of cartesian doubles 0, 1, 2 ... and an integer field of any number of bits.
std::string integers(unsigned bits, std::int64_t minimum, std::int64_t maximum,
                     const std::vector<std::uint64_t>& values) {
  E57Bytes file;
  std::string axis;
  BitStream stream;
  for (std::size_t i = 0; i < values.size(); ++i) {
    axis += bytes_of(static_cast<double>(i));
    stream.put(values[i], bits);
  }
  std::string prototype;
  for (const char* name : {"X", "Y", "Z"})
    prototype += std::string("<cartesian") + name + " type=\"Float\"/>";
  prototype += e57_integer_field("label", minimum, maximum);
  const std::uint64_t place = file.add_section(e57_data_packet({axis, axis, axis, stream.bytes()}));
  return e57_pages(file.finish(e57_scan(place, values.size(), prototype, "")));
}

const std::vector<double>& values_of(const PointCloud& cloud, const std::string& name) {
  for (const Field& field : cloud.fields)
    if (field.info.name == name) return field.values;
  static const std::vector<double> none;
  return none;
}

} // namespace

TEST_CASE("e57: stations with poses, spherical and cartesian, invalid records, colours of 8 and 16 bits") {
  const TemporaryFolder folder;
  CloudReport report;
  const PointCloud cloud =
      read_e57(folder.write("two.e57", e57_pages(e57_two_stations())), {0, {"intensity"}, false}, report);
  REQUIRE(cloud.size() == 3);
  CHECK(report.points_in_file == 3);
  // The file has the quaternion with six decimals; sines of the file's angles round, too.
  CHECK((cloud.position[0] - Eigen::Vector3d(10, 21, 30)).norm() < 1e-12);
  CHECK((cloud.position[1] - Eigen::Vector3d(10 - std::sqrt(3.0), 20, 31)).norm() < 1e-12);
  CHECK(cloud.position[2] == Eigen::Vector3d(4e6 + 0.125, 5, 6));
  REQUIRE(cloud.stations.size() == 2);
  CHECK(cloud.stations[0] == Eigen::Vector3d(10, 20, 30));
  CHECK(cloud.stations[1] == Eigen::Vector3d(0, 0, 0));
  CHECK(report.stations == cloud.stations);
  CHECK(cloud.station == std::vector<std::uint16_t>{0, 0, 1});
  CHECK(report.up == Eigen::Vector3d(0, 0, 1));
  REQUIRE(cloud.colour.size() == 3);
  const float step = 1.0f / 65535.0f; // of 16-bit colours
  CHECK((cloud.colour[0] - Eigen::Vector3f(1, 0, 0)).norm() < step);
  CHECK((cloud.colour[1] - Eigen::Vector3f(0, 0.2f, 0)).norm() < step);
  CHECK((cloud.colour[2] - Eigen::Vector3f(1, 0.5f, 0)).norm() < step);
  REQUIRE(cloud.normal.size() == 3);
  CHECK(cloud.normal[0] == Eigen::Vector3f(0, 0, 0)); // missing
  CHECK(cloud.normal[2] == Eigen::Vector3f(0, 0.6f, 0.8f));
  const std::vector<double>& intensity = values_of(cloud, "intensity");
  REQUIRE(intensity.size() == 3);
  CHECK(intensity[0] == 0.5); // stored 1 above the minimum of -1, times a quarter, plus a half
  CHECK(intensity[1] == 1022 * 0.25 + 0.5);
  CHECK(std::isnan(intensity[2]));
  CHECK_THAT(report.notes.empty() ? "" : report.notes.back(), Contains("1 of 4 records are marked as invalid"));
}

TEST_CASE("e57: integers of every number of bits") {
  const TemporaryFolder folder;
  for (unsigned bits = 0; bits <= 52; ++bits) { // beyond these a double has no room
    INFO(bits << " bits");
    const std::int64_t most = static_cast<std::int64_t>((std::uint64_t{1} << bits) - 1);
    std::vector<std::uint64_t> stored;
    std::vector<double> expected;
    for (std::uint64_t i = 0; i < 40; ++i) {
      stored.push_back((i * 0x9e3779b97f4a7c15u) & static_cast<std::uint64_t>(most));
      expected.push_back(static_cast<double>(static_cast<std::int64_t>(stored.back()) - 7));
    }
    CloudReport report;
    const PointCloud cloud =
        read_e57(folder.write("a.e57", integers(bits, -7, most - 7, stored)), {0, {"label"}, false}, report);
    CHECK(values_of(cloud, "label") == expected);
  }
  // The widest: values that begin at any bit of a byte would need a ninth byte below 64 bits.
  CloudReport report;
  const std::int64_t wide = std::int64_t{1} << 61;
  const std::vector<std::uint64_t> stored{0, std::uint64_t{1} << 61, 12345, (std::uint64_t{1} << 61) + 4096, 0, 7};
  const PointCloud cloud =
      read_e57(folder.write("b.e57", integers(62, 0, wide + 8192, stored)), {0, {"label"}, false}, report);
  std::vector<double> expected;
  for (const std::uint64_t value : stored)
    expected.push_back(static_cast<double>(value));
  CHECK(values_of(cloud, "label") == expected);
}

TEST_CASE("e57: damage is named with its byte") {
  const TemporaryFolder folder;
  CloudReport report;
  const std::string whole = e57_pages(e57_two_stations());
  const auto reading = [&](const std::string& bytes) { return read_e57(folder.write("a.e57", bytes), {}, report); };
  std::string flipped = whole;
  flipped[100] = static_cast<char>(flipped[100] ^ 1);
  CHECK_THROWS_WITH(reading(flipped), Contains("byte 0") && Contains("checksum"));
  CHECK_THROWS_WITH(reading(whole.substr(0, whole.size() - 1024)), Contains("byte 16") && Contains("truncated"));
  CHECK_THROWS_WITH(reading("ASTM-E57"), Contains("byte 8") && Contains("ends within its header"));
  std::string logical = e57_two_stations();
  logical.replace(logical.find("recordCount=\"3\""), 15, "recordCount=\"9\"");
  CHECK_THROWS_WITH(reading(e57_pages(logical)), Contains("expected") && Contains("for 9 records"));
  logical = e57_two_stations();
  logical.replace(logical.find("</data3D>"), 9, "</data4D>");
  CHECK_THROWS_WITH(reading(e57_pages(logical)), Contains("the end of another element") && Contains("byte "));
  logical = e57_two_stations();
  logical.replace(logical.find("sphericalRange"), 14, "sphericalRaage");
  CHECK_THROWS_WITH(reading(e57_pages(logical)), Contains("neither cartesian nor spherical"));
}
