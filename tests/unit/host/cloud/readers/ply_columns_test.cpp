#include "host/cloud/readers/ply.h"
#include "host/cloud/readers/ply_columns.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

std::string bytes_of(double value, bool big_endian) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// The bits of the NaN tell whether it was copied or computed.
const std::string odd_nan = "\x01\x02\x03\x04\x05\x06\xf8\x7f";

/// Three vertices with a list in their middle, behind an element camera and before one of faces.
std::string odd_file(bool big_endian) {
  const auto number = [&](double value) { return bytes_of(value, big_endian); };
  std::string nan = odd_nan;
  if (big_endian) std::reverse(nan.begin(), nan.end());
  std::string text = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                     "_endian 1.0\ncomment of a scanner\nelement camera 1\nproperty list uchar char name\n"
                     "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                     "property list uchar short seen_by\nproperty uchar red\nproperty uchar  green\n"
                     "property uchar blue\nproperty char odd\nelement face 1\n"
                     "property list uchar int vertex_indices\nobj_info behind\nend_header\n";
  text += std::string("\x02") + "ab";
  for (int i = 0; i < 3; ++i) {
    text += i == 1 ? nan : number(500000.125 + i);
    text += number(4e6) + number(-0.0);
    text += std::string(1, static_cast<char>(i)) + std::string(2 * static_cast<std::size_t>(i), '\x07');
    text += std::string("\x10\x20\x30", 3) + static_cast<char>(-1 - i);
  }
  text += std::string("\x03") + std::string(12, '\x05') + "left over";
  return text;
}

std::vector<PointColumn> two_columns() {
  return {{"lit", FieldType::u8, [](std::size_t i) { return i == 1 ? 0.0 : 1.0; }},
          {"red", FieldType::u8, [](std::size_t i) { return 200.0 + static_cast<double>(i); }}};
}

} // namespace

TEST_CASE("a PLY file with columns: the rest stays, byte for byte, in either byte order") {
  const TemporaryFolder folder;
  for (const bool big_endian : {false, true}) {
    const std::string source = folder.write("in.ply", odd_file(big_endian)), out = folder.file("out.ply");
    write_ply_with_columns(source, out, two_columns(), {{"red", "albedo_red"}});
    std::string expected = odd_file(big_endian);
    const auto insert = [&](const std::string& before, const std::string& text) {
      expected.insert(expected.find(before), text);
    };
    insert("element face", "property uchar lit\nproperty uchar red\n");
    expected.replace(expected.find("uchar red\nproperty uchar  green"), 9, "uchar albedo_red");
    std::size_t at = expected.find("end_header\n") + 11 + 3;
    for (int i = 0; i < 3; ++i) {
      at += 24 + 1 + 2 * static_cast<std::size_t>(i) + 4;
      expected.insert(at, std::string(1, i == 1 ? '\0' : '\1') + static_cast<char>(200 + i));
      at += 2;
    }
    CHECK(contents(out) == expected);
  }
}

TEST_CASE("columns that the file has already are replaced, and what was kept once is kept still") {
  const TemporaryFolder folder;
  const std::string source = folder.write("in.ply", odd_file(false));
  const std::string once = folder.file("once.ply"), twice = folder.file("twice.ply");
  write_ply_with_columns(source, once, two_columns(), {{"red", "albedo_red"}});
  write_ply_with_columns(once, twice, two_columns(), {{"red", "albedo_red"}});
  CHECK(contents(twice) == contents(once));
  CHECK(ply_vertex_properties(twice) ==
        std::vector<std::string>{"x", "y", "z", "albedo_red", "green", "blue", "odd", "lit", "red"});
}

TEST_CASE("an ascii file stays one, with its words and its line ends") {
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line : {"ply", "format ascii 1.0", "element vertex 2", "property float x", "property float y",
                             "property float z", "property list uchar int views", "property float quality",
                             "element face 1", "property list uchar int vertex_indices", "end_header",
                             "1e0 +2.50 -0 2 7 8 nan", "", "0.1 0.2 0.3 0 1 9 9", "3 0 1 0"})
      text += line + end;
    const std::string source = folder.write("in.ply", text), out = folder.file("out.ply");
    const std::vector<PointColumn> columns{
        {"share", FieldType::f32, [](std::size_t i) { return i == 0 ? 0.1 : 1.0 / 3.0; }},
        {"count", FieldType::u8, [](std::size_t i) { return 300.0 * static_cast<double>(i); }}};
    write_ply_with_columns(source, out, columns);
    std::string expected;
    for (const char* line :
         {"ply", "format ascii 1.0", "element vertex 2", "property float x", "property float y", "property float z",
          "property list uchar int views", "property float quality", "property float share", "property uchar count",
          "element face 1", "property list uchar int vertex_indices", "end_header", "1e0 +2.50 -0 2 7 8 nan 0.1 0",
          "0.1 0.2 0.3 0 1 0.33333334 300", "3 0 1 0"})
      expected += line + end;
    expected.replace(expected.find("300" + end), 3, "255"); // the end of what a uchar holds
    CHECK(contents(out) == expected);
  }
}

TEST_CASE("columns as a file of their own are read again as they were") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out.ply");
  const double far = 4000000.0009765625; // no float
  write_ply_columns(out, 2,
                    {{"x", FieldType::f64, [=](std::size_t i) { return far + static_cast<double>(i); }},
                     {"y", FieldType::f32, [](std::size_t) { return 0.5; }},
                     {"z", FieldType::i16, [](std::size_t i) { return i == 0 ? -7.0 : 1e9; }},
                     {"stamp", FieldType::u64, [](std::size_t) { return 1e15; }}});
  CloudReport report;
  const PointCloud cloud = read_ply(out, {0.0, {"stamp"}, false}, report);
  REQUIRE(cloud.size() == 2);
  CHECK(cloud.position[1] == Eigen::Vector3d(far + 1.0, 0.5, 32767));
  CHECK(cloud.position[0].z() == -7.0);
  REQUIRE(cloud.fields.size() == 1);
  CHECK(cloud.fields[0].values == std::vector<double>{1e15, 1e15});
  CHECK_THAT(contents(out), Contains("property double stamp\n")); // PLY has no 64-bit integers
}

TEST_CASE("a source that ends too early, or is none, is refused and nothing is written") {
  const TemporaryFolder folder;
  const std::string whole = odd_file(false), out = folder.file("out.ply");
  const std::size_t body = whole.find("end_header\n") + 11, faces = whole.size() - 22;
  for (std::size_t size = 0; size < faces; size += size < body ? 16 : 1) {
    const std::string source = folder.write("cut.ply", whole.substr(0, size));
    CAPTURE(size);
    CHECK_THROWS_AS(write_ply_with_columns(source, out, two_columns()), Error);
  }
  const std::string ascii = folder.write("ascii.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                                                      "property list uchar int v\nend_header\n1 1 1\n2 9000000000 1\n");
  CHECK_THROWS_WITH(write_ply_with_columns(ascii, out, two_columns()), Contains("truncated"));
  CHECK_THROWS_AS(write_ply_with_columns(folder.file("none.ply"), out, two_columns()), Error);
  CHECK_FALSE(std::filesystem::exists(out));
}
