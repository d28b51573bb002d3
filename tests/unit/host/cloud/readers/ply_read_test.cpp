#include "host/cloud/readers/ply.h"
#include "host/error.h"
#include "tests/support/ply_bytes.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <clocale>
#include <cmath>
#include <sys/stat.h>

using namespace pointgi;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
using Eigen::Vector3f;
using pointgi::test::bytes_of;
using pointgi::test::TemporaryFolder;

namespace {

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string little = "ply\nformat binary_little_endian 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

struct Result {
  PointCloud cloud;
  CloudReport report;
};

Result read(const std::string& bytes) {
  const TemporaryFolder folder;
  Result result;
  result.cloud = read_ply(folder.write("cloud.ply", bytes), {}, result.report);
  return result;
}

/// The text of the input error that the bytes must raise.
std::string complaint(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    CHECK_THAT(error.what(), Contains("cloud.ply: "));
    return error.what();
  }
  FAIL("accepted: " << bytes.substr(0, 300));
  return "";
}

std::string use_of(const CloudReport& report, const std::string& property) {
  for (const PropertyUse& use : report.properties)
    if (use.property == property) return use.use;
  return "(not listed)";
}

/// Three vertices and one face in binary, the faces first if asked for.
std::string binary_triangle(bool big_endian, bool faces_first) {
  const std::string vertices_header = "element vertex 3\n" + xyz;
  const std::string faces_header = "element face 1\nproperty list uchar int vertex_indices\n";
  std::string vertices;
  for (int i = 0; i < 9; ++i)
    vertices += bytes_of(static_cast<float>(i) - 2.5f, big_endian);
  std::string faces = bytes_of<std::uint8_t>(3);
  for (const int index : {2, 0, 1})
    faces += bytes_of<std::int32_t>(index, big_endian);
  return std::string("ply\nformat ") + (big_endian ? "binary_big_endian" : "binary_little_endian") + " 1.0\n" +
         (faces_first ? faces_header + vertices_header : vertices_header + faces_header) + "end_header\n" +
         (faces_first ? faces + vertices : vertices + faces);
}

} // namespace

TEST_CASE("ply read: both byte orders and faces before or after the vertices") {
  for (const bool big_endian : {false, true})
    for (const bool faces_first : {false, true}) {
      const auto [cloud, report] = read(binary_triangle(big_endian, faces_first));
      CHECK(report.format == (big_endian ? "PLY 1.0 binary_big_endian" : "PLY 1.0 binary_little_endian"));
      REQUIRE(cloud.size() == 3);
      CHECK(cloud.position[0] == Vector3d(-2.5, -1.5, -0.5));
      CHECK(cloud.position[2] == Vector3d(3.5, 4.5, 5.5));
      REQUIRE(cloud.triangle.size() == 1);
      CHECK(cloud.triangle[0] == std::array<std::uint32_t, 3>{2, 0, 1});
      CHECK(report.points_in_file == 3);
      CHECK(report.triangles == 1);
      CHECK(report.warnings.empty());
      CHECK(use_of(report, "face.vertex_indices (list uchar int)") == "faces");
      CHECK(use_of(report, "vertex.x (float)") == "position");
    }
}

TEST_CASE("ply read: every type as a coordinate in binary and ascii") {
  struct Case {
    std::string type, bytes, text;
    double value;
  };
  for (const bool big : {false, true}) {
    const std::vector<Case> cases{
        {"char", bytes_of<std::int8_t>(-5), "-5", -5.0},
        {"uint8", bytes_of<std::uint8_t>(250), "250", 250.0},
        {"short", bytes_of<std::int16_t>(-30000, big), "-30000", -30000.0},
        {"uint16", bytes_of<std::uint16_t>(60000, big), "60000", 60000.0},
        {"int32", bytes_of<std::int32_t>(-2000000000, big), "-2000000000", -2e9},
        {"uint", bytes_of<std::uint32_t>(4000000000u, big), "4000000000", 4e9},
        {"float32", bytes_of<float>(0.25f, big), "0.25", 0.25},
        {"double", bytes_of<double>(636001.0012345, big), "636001.0012345", 636001.0012345},
    };
    for (const Case& c : cases) {
      INFO(c.type);
      const std::string header = "element vertex 1\nproperty " + c.type + " z\nproperty " + c.type + " x\nproperty " +
                                 c.type + " y\nend_header\n";
      const std::string format = big ? "ply\nformat binary_big_endian 1.0\n" : little;
      CHECK(read(format + header + c.bytes + c.bytes + c.bytes).cloud.position[0] == Vector3d::Constant(c.value));
      CHECK(read(ascii + header + c.text + " " + c.text + " " + c.text).cloud.position[0] ==
            Vector3d::Constant(c.value));
    }
  }
}

TEST_CASE("ply read: the first payload byte may look like a line end") {
  // uchar coordinates make each payload byte count.
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const char first : {'\n', '\r'}) {
      std::string text;
      for (const std::string line : {"ply", "format binary_little_endian 1.0", "element vertex 1", "property uchar x",
                                     "property uchar y", "property uchar z", "end_header"})
        text += line + end;
      const auto [cloud, report] = read(text + first + "\n\r");
      CHECK(cloud.position[0] == Vector3d(first, 10, 13));
      CHECK(report.warnings.empty());
    }
}

TEST_CASE("ply read: ascii bodies with any line end and blank lines") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const std::string line : {"ply", "format ascii 1.0", "element vertex 2", "property float x",
                                   "property float y", "property float z", "end_header", "1 2 3", "", "\t4  5\t6 ", ""})
      text += line + end;
    const auto [cloud, report] = read(text);
    CHECK(cloud.position[1] == Vector3d(4, 5, 6));
    CHECK(report.warnings.empty());
  }
}

TEST_CASE("ply read: normals radius and other properties in any order") {
  const auto [cloud, report] =
      read(ascii + "element vertex 1\nproperty float nz\nproperty float confidence\nproperty double radius\n"
                   "property float y\nproperty list uchar int neighbours\nproperty float x\nproperty float nx\n"
                   "property float z\nproperty float ny\nproperty uchar alpha\nend_header\n"
                   "0.8 0.5 0.125 2 3 7 8 9 1 0.6 3 0 255\n");
  CHECK(cloud.position[0] == Vector3d(1, 2, 3));
  CHECK(cloud.normal[0] == Vector3f(0.6f, 0.0f, 0.8f));
  CHECK(cloud.radius[0] == 0.125f);
  CHECK(cloud.colour.empty());
  CHECK(report.properties.size() == 10);
  CHECK(report.properties[0].property == "vertex.nz (float)"); // in file order
  CHECK(use_of(report, "vertex.nz (float)") == "normal");
  CHECK(use_of(report, "vertex.radius (double)") == "radius");
  CHECK(use_of(report, "vertex.confidence (float)") == "not used");
  CHECK(use_of(report, "vertex.neighbours (list uchar int)") == "not used");
  CHECK(use_of(report, "vertex.alpha (uchar)") == "not used");

  const auto [named, named_report] =
      read(ascii + "element vertex 1\n" + xyz +
           "property float normal_x\nproperty float normal_y\nproperty float normal_z\nend_header\n0 0 0 1 2 3\n");
  CHECK(named.normal[0] == Vector3f(1, 2, 3));
  const auto [partial, partial_report] =
      read(ascii + "element vertex 1\n" + xyz + "property float nx\nproperty float ny\nend_header\n0 0 0 1 2\n");
  CHECK(partial.normal.empty());
  CHECK(use_of(partial_report, "vertex.nx (float)") == "not used");
}

TEST_CASE("ply read: colours by name and type") {
  const auto colour = [](const std::string& type, const std::array<std::string, 3>& names, const std::string& values) {
    std::string header = "element vertex 2\n" + xyz;
    for (const std::string& name : names)
      header += "property " + type + " " + name + "\n";
    return read(ascii + header + "end_header\n0 0 0 " + values + "\n1 1 1 0 0 0\n");
  };
  const float tolerance = 1e-6f; // one multiplication in float
  for (const auto& names : {std::array<std::string, 3>{"red", "green", "blue"},
                            {"r", "g", "b"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue"}}) {
    const auto [cloud, report] = colour("uchar", names, "255 51 0");
    CHECK((cloud.colour[0] - Vector3f(1, 0.2f, 0)).norm() < tolerance);
    CHECK(report.warnings.empty());
    CHECK(use_of(report, "vertex." + names[1] + " (uchar)") == "colour");
  }
  const std::array<std::string, 3> names{"red", "green", "blue"};
  CHECK((colour("ushort", names, "65535 13107 0").cloud.colour[0] - Vector3f(1, 0.2f, 0)).norm() < tolerance);
  CHECK((colour("float", names, "1 0.2 0").cloud.colour[0] - Vector3f(1, 0.2f, 0)).norm() < tolerance);
  CHECK(colour("float", names, "1 0.2 0").report.warnings.empty());
  const auto [wide, report] = colour("float", names, "255 51 0");
  CHECK((wide.colour[0] - Vector3f(1, 0.2f, 0)).norm() < tolerance);
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("0 to 255"));
  CHECK(std::isnan(colour("float", names, "nan 0 0").cloud.colour[0].x()));
}

TEST_CASE("ply read: polygons become fans and several lists may stand in a face") {
  const auto [cloud, report] =
      read(ascii + "element vertex 5\n" + xyz +
           "element face 4\nproperty uchar flags\nproperty list uchar float texcoord\n"
           "property list int uint vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 2\n"
           "7 2 0.5 0.5 4 0 1 2 3\n7 0 3 4 2 0\n7 1 9 2 0 1\n7 0 5 0 1 2 3 4\n");
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 2, 3}, {4, 2, 0},
                                                           {0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  CHECK(cloud.triangle == expected);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("1 faces have fewer than three corners"));
  CHECK(use_of(report, "face.texcoord (list uchar float)") == "not used");
}

TEST_CASE("ply read: triangle strips with restarts keep their winding") {
  const auto [cloud, report] = read(ascii + "element vertex 6\n" + xyz +
                                    "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                                    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 0 0\n2 1 0\n9 0 1 2 3 -1 3 4 5 5\n");
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {2, 1, 3}, {3, 4, 5}};
  CHECK(cloud.triangle == expected);
  CHECK(report.warnings.empty());
}

TEST_CASE("ply read: face indices out of range are refused and -1 drops the face") {
  const auto with_face = [](const std::string& face) {
    return ascii + "element vertex 3\n" + xyz +
           "element face 2\nproperty list char int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" + face +
           "\n";
  };
  for (const std::string index : {"3", "-2", "2147483647"})
    CHECK_THAT(complaint(with_face("3 0 1 " + index)),
               Contains("line 14 (face 1 of 2)") && Contains("vertex index is " + index));
  const auto [cloud, report] = read(with_face("4 0 1 2 -1"));
  CHECK(cloud.triangle.size() == 1);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("1 faces hold the vertex index -1"));

  std::string binary = binary_triangle(false, false);
  binary[binary.size() - 4] = 9;
  const std::size_t face_at = binary.size() - 13;
  CHECK_THAT(complaint(binary), Contains("byte " + std::to_string(face_at) + " ") && Contains("vertex index is 9"));
}

TEST_CASE("ply read: list counts beyond the file or the line are refused") {
  const auto ascii_list = [](const std::string& count_type, const std::string& count) {
    return ascii + "element vertex 1\n" + xyz + "element face 1\nproperty list " + count_type +
           " int vertex_indices\nend_header\n0 0 0\n" + count + " 0 0 0\n";
  };
  for (const auto& [type, count] : std::vector<std::pair<std::string, std::string>>{
           {"int", "-1"}, {"uchar", "255"}, {"uint", "4000000000"}, {"uchar", "4"}})
    CHECK_THAT(complaint(ascii_list(type, count)), Contains("line 11") && Contains("announces " + count + " items"));
  CHECK_THAT(complaint(ascii_list("uchar", "256")), Contains("line 11") && Contains("whole number from 0 to 255"));

  const auto binary_list = [](const std::string& type, const std::string& count) {
    return little + "element face 1\nproperty list " + type + " int vertex_indices\nelement vertex 1\n" + xyz +
           "end_header\n" + count + std::string(12, '\0');
  };
  for (const std::string& file :
       {binary_list("char", bytes_of<std::int8_t>(-1)), binary_list("uchar", bytes_of<std::uint8_t>(255)),
        binary_list("uint", bytes_of<std::uint32_t>(4000000000u)), binary_list("int", bytes_of<std::int32_t>(-5))})
    CHECK_THAT(complaint(file), Contains("byte ") && Contains("expected 0 to 3"));
}

TEST_CASE("ply read: ascii values that are no numbers are named with their line") {
  const auto with_line = [](const std::string& line) {
    return ascii + "element vertex 2\nproperty float x\nproperty int y\nproperty uchar z\nend_header\n0 0 0\n" + line +
           "\n";
  };
  struct Case {
    std::string line, says;
  };
  const std::vector<Case> cases{{"1,5 0 0", "\"1,5\"; the decimal sign is a point"},
                                {"abc 0 0", "\"abc\""},
                                {"1.0x 0 0", "\"1.0x\""},
                                {"0x10 0 0", "\"0x10\""},
                                {"+-1 0 0", "\"+-1\""},
                                {std::string("1\0 0 0", 6), "\"1\\x00\""},
                                {"\xff\xfe 0 0", "\"\\xff\\xfe\""},
                                {"0 1.5 0", "whole number"},
                                {"0 3000000000 0", "from -2147483648 to 2147483647"},
                                {"0 0 256", "from 0 to 255"},
                                {"0 0 -1", "from 0 to 255"},
                                {"0 nan 0", "whole number"},
                                {"1 222222", "fewer values than the header declares"}};
  for (const Case& c : cases)
    CHECK_THAT(complaint(with_line(c.line)), Contains("line 9 (vertex 1 of 2)") && Contains(c.says));
  CHECK(read(with_line("+1e-3 2.0 3")).cloud.position[1] == Vector3d(0.001, 2, 3));
}

TEST_CASE("ply read: nan and inf and numbers beyond double are values in ascii") {
  const auto [cloud, report] = read(ascii + "element vertex 5\n" + xyz +
                                    "end_header\nnan 0 0\n-inf 0 0\nInfinity 0 0\n1e-400 0 0\n-1e400 0 0\n");
  CHECK(std::isnan(cloud.position[0].x()));
  CHECK(cloud.position[1].x() == -HUGE_VAL);
  CHECK(cloud.position[2].x() == HUGE_VAL);
  CHECK(cloud.position[3].x() == 0.0);
  CHECK(cloud.position[4].x() == -HUGE_VAL);
  CHECK(report.points_in_file == 5);
}

TEST_CASE("ply read: the locale does not change numbers") {
  const char* german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  if (german == nullptr) WARN("de_DE.UTF-8 is not installed: checked in the C locale only");
  const PointCloud cloud = read(ascii + "element vertex 1\n" + xyz + "end_header\n1.5 2.25 3\n").cloud;
  std::setlocale(LC_ALL, "C");
  CHECK(cloud.position[0] == Vector3d(1.5, 2.25, 3));
}

TEST_CASE("ply read: extra columns and text after the end are warned of") {
  const auto [cloud, report] = read(ascii + "element vertex 2\n" + xyz + "end_header\n1 2 3\n4 5 6 7 8\nmore\n");
  CHECK(cloud.position[1] == Vector3d(4, 5, 6));
  REQUIRE(report.warnings.size() == 2);
  CHECK_THAT(report.warnings[0], Contains("more values than the header declares (1, the first is line 9"));
  CHECK_THAT(report.warnings[1], Contains("text from line 10 on"));

  const std::string binary = binary_triangle(false, false);
  const auto [same, trailing] = read(binary + "xyz");
  CHECK(same.size() == 3);
  REQUIRE(trailing.warnings.size() == 1);
  CHECK_THAT(trailing.warnings[0], Contains("3 bytes from byte " + std::to_string(binary.size())));
}

TEST_CASE("ply read: files that are no cloud") {
  CHECK_THAT(complaint(""), Contains("line 1") && Contains("empty"));
  CHECK_THAT(complaint("ply"), Contains("line 1"));
  CHECK_THAT(complaint(ascii + "element vertex 0\n" + xyz + "end_header\n"), Contains("the cloud is empty"));
  CHECK_THAT(complaint(ascii + "element face 0\nproperty list uchar int vertex_indices\nend_header\n"),
             Contains("no element vertex"));
  for (const std::string axis : {"x", "y", "z"}) {
    std::string header = ascii + "element vertex 1\n" + xyz + "end_header\n0 0 0\n";
    header.replace(header.find("float " + axis), 7, "float w");
    CHECK_THAT(complaint(header), Contains("line 3: element vertex has no property \"" + axis + "\""));
  }
  CHECK_THAT(complaint(ascii + "element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n"
                               "end_header\n1 0 0 0\n"),
             Contains("no property \"x\""));
  CHECK_THAT(complaint(ascii + "element vertex 3\n" + xyz + "end_header\n1 2 3\n4 5 6 7 8 9 0\n"),
             Contains("line 10 (vertex 2 of 3): the file ends here"));
}

TEST_CASE("ply read: ten thousand properties and a header line of a megabyte") {
  std::string header = ascii + "comment " + std::string(1 << 20, 'c') + "\nelement vertex 1\n" + xyz;
  std::string line = "1 2 3";
  for (int i = 0; i < 10000; ++i) {
    header += "property float p" + std::to_string(i) + "\n";
    line += " " + std::to_string(i);
  }
  const auto [cloud, report] = read(header + "end_header\n" + line + "\n");
  CHECK(cloud.position[0] == Vector3d(1, 2, 3));
  CHECK(report.properties.size() == 10003);
}

TEST_CASE("ply read: coordinates too far out for float are warned of") {
  const auto warnings = [](const std::string& type, double offset) {
    std::string body;
    for (const double step : {0.0, 1.0})
      for (int axis = 0; axis < 3; ++axis)
        body += type == "float" ? bytes_of(static_cast<float>(offset + step)) : bytes_of(offset + step);
    return read(little + "element vertex 2\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
                " z\nend_header\n" + body)
        .report.warnings;
  };
  CHECK(warnings("float", 1.0).empty());
  CHECK(warnings("double", 1e6).empty());
  const auto far = warnings("float", 1e6); // the step of floats is 1/16 there
  REQUIRE(far.size() == 1);
  CHECK_THAT(far[0], Contains("0.0625") && Contains("doubles"));
}

TEST_CASE("ply read: only regular files are opened") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo(folder.file("pipe.ply").c_str(), 0600) == 0);
  for (const auto& [path, says] :
       std::vector<std::pair<std::string, std::string>>{{folder.file("missing.ply"), "No such file"},
                                                        {folder.file(""), "is a folder"},
                                                        {folder.file("pipe.ply"), "is a pipe"},
                                                        {"/dev/zero", "is a device"}}) {
    CloudReport report;
    try {
      read_ply(path, {}, report);
      FAIL("accepted: " << path);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::input);
      CHECK_THAT(error.what(), Contains(path) && Contains(says));
    }
  }
}
