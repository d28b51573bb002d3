#include "host/cloud/readers/text.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
using Eigen::Vector3f;
using pointgi::test::TemporaryFolder;

namespace {

struct Read {
  PointCloud cloud;
  CloudReport report;
};

Read read(const std::string& text, const ReadRequest& request = {}, const char* name = "cloud.txt") {
  const TemporaryFolder folder;
  Read result;
  result.cloud = read_text(folder.write(name, text), request, result.report);
  return result;
}

/// `count` lines, each made from its number.
template <class Line>
std::string lines(int count, Line line) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += line(i) + "\n";
  return text;
}
std::string n(double value) {
  return std::to_string(value);
}
std::string whole(int value) {
  return std::to_string(value);
}
std::string xyz(int i) {
  return n(0.1 * i) + " " + n(7 + 0.01 * i * i) + " " + n(-i);
}
/// A unit vector, with six decimals.
std::string normal(int i) {
  return n(std::cos(0.3 * i)) + " " + n(std::sin(0.3 * i)) + " 0.000000";
}
std::string rgb(int i) {
  return whole(i % 256) + " " + whole(255 - i % 256) + " 40";
}

std::vector<std::string> names_of(const CloudReport& report) {
  std::vector<std::string> names;
  for (const PropertyUse& p : report.properties)
    names.push_back(p.property.substr(0, p.property.find(" (")));
  return names;
}
using Names = std::vector<std::string>;

} // namespace

TEST_CASE("text: three columns are positions, kept as doubles") {
  const Read r = read("665187.522077 5648349.895035 241.767693\n-1e-3 2 +3\n");
  REQUIRE(r.cloud.size() == 2);
  CHECK(r.cloud.position[0] == Vector3d(665187.522077, 5648349.895035, 241.767693));
  CHECK(r.cloud.position[1] == Vector3d(-1e-3, 2, 3));
  CHECK(r.cloud.colour.empty());
  CHECK(r.report.points_in_file == 2);
  CHECK_THAT(r.report.notes.at(0), Contains("separated by blanks") && Contains("x, y, z (by what they hold)"));
}

TEST_CASE("text: columns without names are told by what they hold") {
  const auto names = [](auto line) { return names_of(read(lines(300, line)).report); };
  CHECK(names([](int i) { return xyz(i) + " " + n(i % 40); }) == Names{"x", "y", "z", "intensity"});
  CHECK(names([](int i) { return xyz(i) + " " + rgb(i); }) == Names{"x", "y", "z", "red", "green", "blue"});
  CHECK(names([](int i) { return xyz(i) + " " + normal(i); }) == Names{"x", "y", "z", "nx", "ny", "nz"});
  CHECK(names([](int i) { return xyz(i) + " " + whole(i - 150) + " " + rgb(i); }) ==
        Names{"x", "y", "z", "intensity", "red", "green", "blue"});
  CHECK(names([](int i) { return xyz(i) + " " + rgb(i) + " " + n(i); }) ==
        Names{"x", "y", "z", "red", "green", "blue", "intensity"});
  CHECK(names([](int i) { return xyz(i) + " " + rgb(i) + " 255"; }) ==
        Names{"x", "y", "z", "red", "green", "blue", "column 7"}); // an opacity says nothing
  CHECK(names([](int i) { return xyz(i) + " " + rgb(i) + " " + normal(i); }) ==
        Names{"x", "y", "z", "red", "green", "blue", "nx", "ny", "nz"});
  CHECK(names([](int i) { return xyz(i) + " " + normal(i) + " " + rgb(i); }) ==
        Names{"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"});
  CHECK(names([](int i) { return xyz(i) + " " + n(i) + " " + rgb(i) + " " + normal(i); }) ==
        Names{"x", "y", "z", "intensity", "red", "green", "blue", "nx", "ny", "nz"});
  // Neither unit, nor whole, nor 0..1.
  CHECK(names([](int i) { return xyz(i) + " " + xyz(i); }) == Names{"x", "y", "z", "column 4", "column 5", "column 6"});
}

TEST_CASE("text: a few lines do not decide what a column is") {
  // One colour of 300 and one normal that is missing, of 300 lines.
  const auto names = [](auto line) { return names_of(read(lines(300, line)).report); };
  CHECK(names([](int i) { return xyz(i) + " " + (i == 9 ? "300 0 0" : rgb(i)); })[3] == "red");
  CHECK(names([](int i) { return xyz(i) + " " + (i == 9 ? "0 0 0" : normal(i)); })[3] == "nx");
  // Axes of whole numbers are normals, not dark colours.
  CHECK(names([](int i) { return xyz(i) + (i % 2 == 0 ? " 0 0 1" : " 0 1 0"); })[3] == "nx");
}

TEST_CASE("text: colours of 8 bits, of 16 bits and of fractions") {
  const auto first = [](auto line) { return read(lines(300, line)).cloud.colour.at(0); };
  CHECK((first([](int i) { return xyz(i) + " 51 102 255"; }) - Vector3f(0.2f, 0.4f, 1.0f)).norm() < 1e-6f);
  CHECK((first([](int i) { return xyz(i) + " 13107 26214 " + whole(65535 - i); }) - Vector3f(0.2f, 0.4f, 1.0f)).norm() <
        1e-6f);
  CHECK((first([](int i) { return xyz(i) + " 0.2 0.4 " + n(1 - 0.003 * i); }) - Vector3f(0.2f, 0.4f, 1.0f)).norm() <
        1e-6f);
}

TEST_CASE("text: headers name the columns") {
  SECTION("in quotes, with units, commas and names of blanks") {
    const Read r = read("\"Y [m]\",\"X [m]\",\"Z [m]\",\"significant change\",\"NormalX\",\"NormalY\",\"NormalZ\"\n"
                        "1,2,3,nan,0,0,1,\n4,5,6,0.5,0,1,0,\n");
    CHECK(r.cloud.position[0] == Vector3d(2, 1, 3));
    CHECK(r.cloud.normal[1] == Vector3f(0, 1, 0));
    CHECK(names_of(r.report)[3] == "significant change");
    CHECK_THAT(r.report.notes.at(0), Contains("separated by commas") && Contains("by the names in line 1"));
  }
  SECTION("as CloudCompare writes them, in a comment before a count") {
    const Read r = read("//X Y Z R G B Intensity\n2\n1 2 3 255 0 0 0.25\n4 5 6 0 255 0 0.5\n");
    REQUIRE(r.cloud.size() == 2);
    CHECK(r.cloud.colour[1] == Vector3f(0, 1, 0));
    CHECK(names_of(r.report).back() == "Intensity");
    CHECK(r.report.warnings.empty());
  }
  SECTION("of maps and of other programs") {
    CHECK(read("Easting;Northing;Elevation\n1;2;3\n").cloud.position[0] == Vector3d(1, 2, 3));
    CHECK(read("\"Points:0\",\"Points:1\",\"Points:2\"\n1,2,3\n").cloud.position[0] == Vector3d(1, 2, 3));
    CHECK(read("\xef\xbb\xbfx\ty\tz\r\n1\t2\t3\r\n").cloud.position[0] == Vector3d(1, 2, 3));
  }
  SECTION("without x, y and z they do not") {
    CHECK_THROWS_WITH(read("# scan\n\nlon,lat,h\n1,2,3\n"), Contains("cloud.txt: line 3 has no property \"x\""));
  }
}

TEST_CASE("text: comments are no names unless they name as many as there are columns") {
  const Read r = read("# made by a scanner in x y z\n; another\n// one more\n1 2 3\n# inside\n\n4 5 6\n");
  CHECK(r.cloud.size() == 2);
  CHECK_THAT(r.report.notes.at(0), Contains("by what they hold"));
  CHECK(read("# z y x\n1 2 3\n").cloud.position[0] == Vector3d(3, 2, 1));
}

TEST_CASE("text: separators and decimal commas") {
  for (const char* text : {"1.5 2.5 -3.5\n0 1 2\n", "1.5\t2.5\t-3.5\n0\t1\t2\n", "1.5,2.5,-3.5\n0,1,2\n",
                           "1.5, 2.5, -3.5\n0, 1, 2\n", "1.5;2.5;-3.5\n0;1;2\n", "1,5;2,5;-3,5\n0;1;2\n",
                           "1,5\t2,5\t-3,5\n0\t1\t2\n", "1,5 2,5 -3,5\n0 1 2\n", "1.5,2.5,-3.5,\r\n0,1,2,\r\n"}) {
    INFO(text);
    const Read r = read(text);
    REQUIRE(r.cloud.size() == 2);
    CHECK(r.cloud.position[0] == Vector3d(1.5, 2.5, -3.5));
  }
}

TEST_CASE("text: a few decimal commas decide, however many whole numbers stand beside them") {
  const Read r = read("X;Y;Z;R;G;B\n1,5;2;3;10;20;30\n4;5;6,25;10;20;30\n");
  CHECK(r.cloud.position[0] == Vector3d(1.5, 2, 3));
  CHECK(r.cloud.position[1] == Vector3d(4, 5, 6.25));
}

TEST_CASE("text: PTS has a count before each block") {
  const Read r = read("2\n1 2 3 -100 255 0 0\n4 5 6 -99 0 0 255\n1\n7 8 9 -98 0 255 0\n", {}, "scan.pts");
  REQUIRE(r.cloud.size() == 3);
  CHECK(r.cloud.position[2] == Vector3d(7, 8, 9));
  CHECK(r.cloud.colour[2] == Vector3f(0, 1, 0));
  CHECK(r.report.format == "PTS");
  CHECK(r.report.warnings.empty());
}

TEST_CASE("text: what a count announces and what follows may differ, which is told") {
  const Read r = read("3\n1 2 3\n4 5 6\n", {}, "scan.pts");
  CHECK(r.cloud.size() == 2);
  CHECK_THAT(r.report.warnings.at(0), Contains("line 1 announces 3 points and 2 follow"));
  // However many counts are wrong, one sentence says so.
  const Read many = read("1 2 3\n" + lines(2000, [](int i) { return whole(i + 1); }));
  REQUIRE(many.report.warnings.size() == 1);
  CHECK_THAT(many.report.warnings[0], Contains("1999 lines more"));
  CHECK_THROWS_WITH(read("-1\n1 2 3\n"), Contains("line 1: the line announces -1 points"));
  CHECK_THROWS_WITH(read("0\n"), Contains("line 1: the file ends without a point"));
  CHECK(read("9223372036854775808\n1 2 3\n").report.warnings.size() == 1);
}

TEST_CASE("text: points3D.txt of COLMAP") {
  const std::string points = lines(20, [](int i) {
    std::string track;
    for (int k = 0; k <= i % 4; ++k)
      track += " " + whole(k) + " " + whole(100 + k);
    return whole(1000 + i) + " " + xyz(i) + " " + rgb(i) + " 0.5" + track;
  });
  const std::string comments = "# 3D point list with one line of data per point:\n"
                               "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n"
                               "# Number of points: 20, mean track length: 2.5\n";
  for (const std::string& text : {comments + points, points}) {
    const Read r = read(text);
    REQUIRE(r.cloud.size() == 20);
    CHECK(r.report.format == "points3D.txt of COLMAP");
    CHECK(r.cloud.position[3] == Vector3d(0.3, 7.09, -3));
    CHECK(r.cloud.colour[0].isApprox(Vector3f(0, 255, 40) / 255));
  }
  CHECK_THROWS_WITH(read("# Image list with two lines of data per image:\n#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, "
                         "CAMERA_ID, NAME\n1 1 0 0 0 0 0 0 1 a.jpg\n3 4 -1\n"),
                    Contains("line 2: this is COLMAP's list of images") && Contains("points3D.txt"));
  CHECK_THROWS_WITH(read("#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n1 PINHOLE 10 10 5 5 5 5\n"),
                    Contains("list of cameras"));
}

TEST_CASE("text: columns are kept where they are asked for") {
  ReadRequest request;
  request.fields = {"Classification"};
  const Read r = read("X;Y;Z;Intensity;Classification;Name\n1;2;3;7;2;wall\n4;5;6;8;;roof\n", request);
  REQUIRE(r.cloud.fields.size() >= 1);
  const Field& field = r.cloud.fields.back();
  CHECK(field.info.name == "Classification");
  CHECK(field.values[0] == 2.0);
  CHECK(std::isnan(field.values[1])); // nothing stands there
}

TEST_CASE("text: many pieces are read as one, and errors name the line") {
  // Several MB, so that it is read in pieces; each point tells its number.
  constexpr int count = 150000;
  const auto line = [](int i) { return whole(i) + " " + whole(i + 1) + " " + whole(i + 2) + " 12.5"; };
  std::string text = "# comment\n" + lines(count, line);
  const Read r = read(text);
  REQUIRE(r.cloud.size() == count);
  std::size_t right = 0;
  for (int i = 0; i < count; ++i)
    right += r.cloud.position[static_cast<std::size_t>(i)] == Vector3d(i, i + 1, i + 2) ? 1u : 0u;
  CHECK(right == count);

  const std::string victim = "\n" + line(140000) + "\n";
  text.replace(text.find(victim), victim.size(), "\n140000 abc 5 12.5\n");
  CHECK_THROWS_WITH(read(text), Contains("line 140002: expected a number for y (value 2 of the line), found \"abc\""));
  text.replace(text.find("140000 abc 5 12.5"), 17, "140000 7");
  CHECK_THROWS_WITH(read(text), Contains("line 140002: 2 values, expected 4 or more"));
}

TEST_CASE("text: what is no table of points is refused with its place") {
  CHECK_THROWS_WITH(read(""), Contains("line 1: the file ends without a point"));
  CHECK_THROWS_WITH(read("# only\n# comments\n"), Contains("line 2: the file ends without a point"));
  CHECK_THROWS_WITH(read("hello world\nthis is prose\n"), Contains("cloud.txt: line 1"));
  CHECK_THROWS_WITH(read("1 2\n3 4\n"), Contains("line 1: expected x y z and more"));
  CHECK_THROWS_WITH(read("1 2 3\n1 2 3 4\n1 2 3 4 5\n1 2 3 4 5 6\n"), Contains("different numbers of values"));
  CHECK_THROWS_WITH(read(std::string("1 2\0 3\n", 7)), Contains("byte 3: this is no text"));
  CHECK_THROWS_WITH(read("\xff\xfe"
                         "1"),
                    Contains("UTF-16"));
}

TEST_CASE("text: tables are recognised, other text is not") {
  const auto recognised = [](const std::string& text) { return recognises_text(text.data(), text.size()); };
  CHECK(recognised("1 2 3\n4 5 6\n"));
  CHECK(recognised("//X Y Z\n1 2 3\n"));
  CHECK(recognised("x;y;z\n1;2;3\n"));
  CHECK(recognised(lines(500, xyz).substr(0, 4096))); // cut within a line
  CHECK_FALSE(recognised("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  CHECK_FALSE(recognised("v 1 2 3\nv 4 5 6\nf 1 2 3\n"));
  CHECK_FALSE(recognised("solid a\nfacet normal 0 0 1\n"));
  CHECK_FALSE(recognised("ply\nformat ascii 1.0\n"));
  CHECK_FALSE(recognised("1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n")); // PTX
  CHECK_FALSE(recognised(""));
}
