/// What converters and capture programs write into PLY files, beside the plain attributes.
#include "host/cloud/readers/ply.h"
#include "host/error.h"
#include "tests/support/ply_bytes.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

using namespace pointgi;
using Catch::Contains;
using Eigen::Vector3d;
using Eigen::Vector3f;
using pointgi::test::bytes_of;
using pointgi::test::TemporaryFolder;

namespace {

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

struct Result {
  PointCloud cloud;
  CloudReport report;
};

Result read(const std::string& bytes, const ReadRequest& request = {}) {
  const TemporaryFolder folder;
  Result result;
  result.cloud = read_ply(folder.write("cloud.ply", bytes), request, result.report);
  return result;
}

std::string use_of(const CloudReport& report, const std::string& property) {
  for (const PropertyUse& use : report.properties)
    if (use.property == property) return use.use;
  return "(not listed)";
}

/// `count` points of the same line.
std::string cloud_text(const std::string& properties, const std::string& line, std::size_t count,
                       const std::string& first_line) {
  std::string text =
      ascii + "element vertex " + std::to_string(count) + "\n" + xyz + properties + "end_header\n" + first_line + "\n";
  for (std::size_t i = 1; i < count; ++i)
    text += line + "\n";
  return text;
}

std::string properties(const std::string& type, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += "property " + type + " " + name + "\n";
  return text;
}

const Vector3f brick(190 / 255.0f, 80 / 255.0f, 50 / 255.0f);
const float rounding = 1e-6f; // one multiplication in float, of values up to 1

bool near(const Vector3f& a, const Vector3f& b) {
  return (a - b).cwiseAbs().maxCoeff() < rounding;
}

} // namespace

TEST_CASE("ply kinds: PDAL's normalx and 8-bit colours in ushorts", "[fields]") {
  const auto [cloud, report] = read(cloud_text(properties("double", {"normalx", "normaly", "normalz"}) +
                                                   properties("ushort", {"red", "green", "blue"}),
                                               "1 2 3 0 0 1 190 80 50", 10, "0 0 0 0 1 0 190 80 50"));
  CHECK(cloud.normal[0] == Vector3f(0, 1, 0));
  CHECK(near(cloud.colour[9], brick));
  CHECK(report.warnings.empty());
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("16-bit") && Contains("0 to 255"));
}

TEST_CASE("ply kinds: one colour out of range does not darken the others", "[fields]") {
  const auto floats = read(
      cloud_text(properties("float", {"red", "green", "blue"}), "0 0 0 0.75 0.25 0.5", 1500, "0 0 0 1.02 0.25 0.5"));
  CHECK(near(floats.cloud.colour[0], {1, 0.25f, 0.5f}));
  CHECK(near(floats.cloud.colour[1], {0.75f, 0.25f, 0.5f}));
  const auto shorts = read(
      cloud_text(properties("ushort", {"red", "green", "blue"}), "0 0 0 190 80 50", 1500, "0 0 0 65535 65535 65535"));
  CHECK(near(shorts.cloud.colour[0], {1, 1, 1}));
  CHECK(near(shorts.cloud.colour[1], brick));
  for (const CloudReport& report : {floats.report, shorts.report}) {
    REQUIRE(report.warnings.size() == 1);
    CHECK_THAT(report.warnings[0], Contains("the colours of 1 of 1500 points are above"));
  }
}

TEST_CASE("ply kinds: colours by the names of CloudCompare, Blender and others", "[fields]") {
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{"scalar_R", "scalar_G", "scalar_B"},
                                             {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                             {"r", "g", "b"},
                                             {"Red", "Green", "Blue"}}) {
    const auto [cloud, report] = read(cloud_text(properties("float", names), "0 0 0 190 80 50", 3, "0 0 0 190 80 50"));
    CHECK(near(cloud.colour.at(0), brick));
  }
}

TEST_CASE("ply kinds: packed colours in text and in both byte orders", "[fields]") {
  const auto as_text = read(cloud_text("property float rgb\n", "0 0 0 1.74775129e-38", 2, "0 0 0 1.74775129e-38"));
  CHECK(near(as_text.cloud.colour[0], brick)); // the float of the bits 0x00be5032
  const auto as_uint = read(cloud_text("property uint rgba\n", "0 0 0 4290662450", 2, "0 0 0 4290662450"));
  CHECK(near(as_uint.cloud.colour[1], brick));
  for (const bool big : {false, true})
    for (const std::uint32_t bits : {0x00be5032u, 0xffbe5032u}) { // the second is no number as a float
      const std::string header = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                                 " 1.0\nelement vertex 1\n" + xyz + "property float rgb\nend_header\n";
      const auto [cloud, report] = read(header + std::string(12, '\0') + bytes_of(bits, big));
      CHECK(near(cloud.colour[0], brick));
      CHECK(use_of(report, "vertex.rgb (float)") == "colour");
    }
}

TEST_CASE("ply kinds: missing normals lose no point", "[fields]") {
  const std::string normals = properties("float", {"nx", "ny", "nz"});
  const auto some = read(cloud_text(normals, "0 0 1 nan nan nan", 100, "1 0 0 0 0 1"));
  REQUIRE(some.cloud.size() == 100);
  CHECK(some.cloud.normal[0] == Vector3f(0, 0, 1));
  CHECK(some.cloud.normal[1] == Vector3f::Zero());
  const auto none = read(cloud_text(normals, "0 0 1 0 0 0", 100, "1 0 0 0 0 0"));
  CHECK(none.cloud.size() == 100);
  CHECK(none.cloud.normal.empty());
  REQUIRE(none.report.notes.size() == 1);
}

TEST_CASE("ply kinds: colours of faces go to their vertices", "[fields]") {
  const std::string mesh = ascii + "element vertex 5\n" + xyz +
                           "element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar "
                           "green\nproperty uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 9 9\n";
  const auto [cloud, report] = read(mesh + "3 0 1 2 190 80 50\n3 1 3 2 90 80 50\n");
  REQUIRE(cloud.colour.size() == 5);
  CHECK(near(cloud.colour[0], brick));
  CHECK(near(cloud.colour[1], {140 / 255.0f, 80 / 255.0f, 50 / 255.0f})); // of both faces
  CHECK(near(cloud.colour[3], {90 / 255.0f, 80 / 255.0f, 50 / 255.0f}));
  CHECK(near(cloud.colour[4], {140 / 255.0f, 80 / 255.0f, 50 / 255.0f})); // of none
  CHECK(cloud.triangle.size() == 2);
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("colours for its faces only"));
  CHECK(use_of(report, "face.red (uchar)") == "colour");

  const auto [own, own_report] = read(ascii + "element vertex 3\n" + xyz +
                                      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
                                      "1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar "
                                      "green\nproperty uchar blue\nend_header\n0 0 0 190 80 50\n1 0 0 190 80 50\n0 1 0 "
                                      "190 80 50\n3 0 1 2 0 0 0\n");
  CHECK(near(own.colour[0], brick));
  CHECK(use_of(own_report, "face.red (uchar)") == "not used");
}

TEST_CASE("ply kinds: intensity alone stands in for colours", "[fields]") {
  const auto [cloud, report] =
      read(cloud_text("property ushort scalar_Intensity\nproperty float quality\n", "0 0 0 400 1", 3, "0 0 0 7 1"));
  CHECK(cloud.colour.empty());
  REQUIRE(cloud.fields.size() == 1);
  CHECK(cloud.fields[0].values == std::vector<double>{7, 400, 400});
  CHECK(use_of(report, "vertex.scalar_Intensity (ushort)") == "colour (grey)");
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("not used: quality;"));
}

TEST_CASE("ply kinds: fields that are asked for are kept as they are", "[fields]") {
  const std::string text = cloud_text("property uchar class\nproperty list uchar int n\nproperty double time\n",
                                      "1 2 3 5 0 4.5", 2, "0 0 0 6 2 8 9 3.5");
  const auto some = read(text, {0.0, {"Time", "absent"}, false});
  REQUIRE(some.cloud.fields.size() == 1);
  CHECK(some.cloud.fields[0].info.name == "time");
  CHECK(some.cloud.fields[0].values == std::vector<double>{3.5, 4.5});
  const auto all = read(text, {0.0, {}, true});
  REQUIRE(all.cloud.fields.size() == 5);
  CHECK(all.cloud.fields[3].info.type == FieldType::u8);
  CHECK(all.cloud.fields[3].values == std::vector<double>{6, 5});
  CHECK(all.report.fields == std::vector<std::string>{"x", "y", "z", "class", "time"});
}

TEST_CASE("ply kinds: scanner positions and which way is up", "[fields]") {
  const auto file = [](const std::string& stations, const std::string& places, const std::string& lines) {
    return ascii + "comment pointgi up z\nelement station " + stations +
           "\nproperty double x\nproperty double y\nproperty double z\nelement vertex 3\n" + xyz +
           "property ushort station\nend_header\n" + places + lines;
  };
  const auto [cloud, report] = read(file("2", "1 2 3.5\n4 5 6\n", "0 0 0 1\n1 0 0 0\n0 1 0 1\n"));
  CHECK(cloud.stations == std::vector<Vector3d>{{1, 2, 3.5}, {4, 5, 6}});
  CHECK(cloud.station == std::vector<std::uint16_t>{1, 0, 1});
  CHECK(report.stations == cloud.stations);
  CHECK(report.up == Vector3d::UnitZ());
  CHECK(use_of(report, "station.x (double)") == "scanner position");
  CHECK(use_of(report, "vertex.station (ushort)") == "scanner position");
  CHECK(report.notes.empty());
  CHECK_THROWS_WITH(read(file("2", "1 2 3.5\n4 5 6\n", "0 0 0 1\n1 0 0 0\n0 1 0 2\n")),
                    Contains("cloud.ply: line 4: vertex 2 names a station that there is not; expected 0 to 1"));

  CHECK_THROWS_WITH(read(file("1", "1 nan 3.5\n", "0 0 0 0\n1 0 0 0\n0 1 0 0\n")),
                    Contains("line 14 (station 0 of 1): a scanner position is not finite"));

  // One station needs no index, and an index without stations says nothing.
  const auto one = read(ascii + "element vertex 2\n" + xyz +
                        "element station 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 "
                        "0\n1 1 1\n7 8 9\n");
  CHECK(one.cloud.station == std::vector<std::uint16_t>{0, 0});
  CHECK(one.cloud.stations == std::vector<Vector3d>{{7, 8, 9}});
  const auto none = read(cloud_text("property ushort station\n", "0 0 0 3", 2, "0 0 0 3"));
  CHECK(none.cloud.station.empty());
  CHECK(use_of(none.report, "vertex.station (ushort)") == "not used");
}

TEST_CASE("ply kinds: more text than is read at once", "[fields]") {
  // 600,000 lines of about 20 bytes: a block of 12 MB of many pieces, and the faces begin within a piece.
  constexpr std::size_t count = 600000;
  std::string text = ascii + "element vertex " + std::to_string(count) + "\n" + xyz +
                     "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::size_t header_lines = 9;
  std::vector<std::size_t> line_begin;
  for (std::size_t i = 0; i < count; ++i) {
    line_begin.push_back(text.size());
    text += std::to_string(i) + " 1.25 " + std::to_string(2 * i) + (i % 3 == 0 ? "\r\n" : "\n");
  }
  text += "3 0 1 2\n\n3 2 1 599999\n";
  const auto [cloud, report] = read(text);
  REQUIRE(cloud.size() == count);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(static_cast<float>(i));
    wrong += cloud.position[i] == Vector3d(x, 1.25, 2 * x) ? 0u : 1u;
  }
  CHECK(wrong == 0);
  CHECK(cloud.triangle == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 1, 599999}});
  CHECK(report.warnings.empty());

  for (const std::size_t bad : {std::size_t{3}, count / 2, count - 1}) {
    std::string broken = text;
    broken[line_begin[bad]] = 'x';
    if (bad < count - 1) broken[line_begin[count - 1]] = 'y'; // the first fault is told, whoever meets his first
    CHECK_THROWS_WITH(read(broken), Contains("line " + std::to_string(header_lines + bad + 1) + " (vertex " +
                                             std::to_string(bad) + " of "));
  }
  const std::string cut = text.substr(0, line_begin[400000]);
  CHECK_THROWS_WITH(read(cut), Contains("line " + std::to_string(header_lines + 400001) +
                                        " (vertex 400000 of 600000): the file ends here; it is truncated"));
  std::string face = text;
  face.replace(face.rfind("599999"), 6, "600000");
  CHECK_THROWS_WITH(read(face),
                    Contains("line " + std::to_string(header_lines + count + 3) + " (face 1 of 2): a vertex index"));
}

TEST_CASE("ply kinds: more bytes than are read at once", "[fields]") {
  constexpr std::uint32_t count = 300000; // of 15 bytes: some pieces of a megabyte
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                        " 1.0\nelement camera 2\nproperty float focal\nproperty uchar id\nelement vertex " +
                        std::to_string(count) + "\n" + xyz +
                        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list "
                        "uchar int vertex_indices\nend_header\n";
    bytes += std::string(10, '\1');
    const std::size_t body = bytes.size();
    for (std::uint32_t i = 0; i < count; ++i)
      bytes += bytes_of(static_cast<float>(i), big) + bytes_of(0.5f, big) + bytes_of(-static_cast<float>(i), big) +
               std::string("\xbe\x50\x32", 3);
    bytes += "\3" + bytes_of<std::uint32_t>(0, big) + bytes_of<std::uint32_t>(1, big) +
             bytes_of<std::uint32_t>(count - 1, big);
    const auto [cloud, report] = read(bytes);
    REQUIRE(cloud.size() == count);
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto x = static_cast<double>(i);
      wrong += cloud.position[i] == Vector3d(x, 0.5, -x) && near(cloud.colour[i], brick) ? 0u : 1u;
    }
    CHECK(wrong == 0);
    CHECK(cloud.triangle.at(0)[2] == count - 1);
    CHECK(report.warnings.empty());
    // A file without room for the announced points is refused by its counts.
    CHECK_THROWS_WITH(read(bytes.substr(0, body + 15u * 1000)), Contains("announces 300000 records"));
  }
}
