#include "host/cloud/readers/ptx.h"
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

Read read(const std::string& text) {
  const TemporaryFolder folder;
  Read result;
  result.cloud = read_ptx(folder.write("scan.ptx", text), {}, result.report);
  return result;
}

/// A header of `columns` x `rows`, turned by a quarter about z, x to y, and moved.
std::string header(int columns, int rows, const std::string& move = "1000 2000 30") {
  return std::to_string(columns) + "\n" + std::to_string(rows) + "\n" + move + "\n0 1 0\n-1 0 0\n0 0 1\n" +
         "0 1 0 0\n-1 0 0 0\n0 0 1 0\n" + move + " 1\n";
}

} // namespace

TEST_CASE("ptx: points are taken to the world, rays without a return are none") {
  const Read r = read(header(2, 2) + "1 2 3 0.5 255 0 0\n0 0 0 0.5 0 0 0\n0.000000 0.0 -0 0 0 0 0\n0 4 0 1 0 0 255\n");
  REQUIRE(r.cloud.size() == 2);
  CHECK(r.cloud.position[0] == Vector3d(1000 - 2, 2000 + 1, 30 + 3));
  CHECK(r.cloud.position[1] == Vector3d(1000 - 4, 2000, 30));
  CHECK(r.cloud.colour[0] == Vector3f(1, 0, 0));
  CHECK(r.cloud.colour[1] == Vector3f(0, 0, 1));
  CHECK(r.cloud.stations == std::vector<Vector3d>{Vector3d(1000, 2000, 30)});
  CHECK(r.cloud.station == std::vector<std::uint16_t>{0, 0});
  CHECK(r.report.stations == r.cloud.stations);
  CHECK(r.report.up == Vector3d(0, 0, 1));
  CHECK(r.report.points_in_file == 2);
  CHECK_THAT(r.report.notes.back(), Contains("1 scanner position with 2 points; 2 rays had no return"));
}

TEST_CASE("ptx: millimetres of map coordinates are kept") {
  const Read r = read(header(1, 1, "500100.25 4000050.5 12.125") + "0.001 0.002 0.003 0.5\n");
  // Doubles of 4e6 have steps of 5e-10.
  CHECK((r.cloud.position[0] - Vector3d(500100.248, 4000050.501, 12.128)).norm() < 1e-9);
}

TEST_CASE("ptx: each grid with points is a station") {
  std::string text = header(1, 3) + "1 0 0 0.1\n2 0 0 0.2\n0 0 0 0\n";
  text += header(2, 1, "5 5 5") + "0 0 0 0.5\n0 0 0 0.5\n"; // nothing came back
  text += header(1, 1, "7 8 9") + "1 1 1 0.3\n\n";
  for (const bool crlf : {false, true}) {
    if (crlf)
      for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
        text.replace(at, 1, "\r\n");
    const Read r = read(text);
    REQUIRE(r.cloud.size() == 3);
    CHECK(r.cloud.stations == std::vector<Vector3d>{Vector3d(1000, 2000, 30), Vector3d(7, 8, 9)});
    CHECK(r.cloud.station == std::vector<std::uint16_t>{0, 0, 1});
    CHECK(r.cloud.position[2] == Vector3d(6, 9, 10));
  }
}

TEST_CASE("ptx: where the matrix moves nothing the scanner's position is the station") {
  const Read r = read("1\n1\n3 4 5\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n9 9 9 0.5\n");
  CHECK(r.cloud.position[0] == Vector3d(9, 9, 9));
  CHECK(r.cloud.stations[0] == Vector3d(3, 4, 5));
}

TEST_CASE("ptx: a matrix for column vectors is recognised") {
  const Read r = read("1\n1\n7 8 9\n1 0 0\n0 1 0\n0 0 1\n0 -1 0 7\n1 0 0 8\n0 0 1 9\n0 0 0 1\n1 2 3 0.5\n");
  CHECK(r.cloud.position[0] == Vector3d(7 - 2, 8 + 1, 9 + 3));
  CHECK(r.cloud.stations[0] == Vector3d(7, 8, 9));
  CHECK_THAT(r.report.notes.back(), Contains("column vectors"));
}

TEST_CASE("ptx: grids with and without colours in one file") {
  const Read r = read(header(1, 1) + "1 0 0 0.4\n" + header(1, 1) + "1 0 0 0.5 255 0 0\n");
  REQUIRE(r.cloud.colour.size() == 2);
  CHECK(r.cloud.colour[0].isApprox(Vector3f::Constant(0.4f)));
  CHECK(r.cloud.colour[1] == Vector3f(1, 0, 0));
}

TEST_CASE("ptx: large grids are read in pieces, and errors name the line") {
  constexpr int rows = 120000;
  std::string text = header(1, rows);
  for (int i = 0; i < rows; ++i)
    text += i % 3 == 0 ? "0 0 0 0.500000\n" : std::to_string(i) + " 0.25 1 0.500000\n";
  const Read r = read(text);
  REQUIRE(r.cloud.size() == rows - rows / 3);
  std::size_t right = 0, next = 0;
  for (int i = 0; i < rows; ++i)
    if (i % 3 != 0) right += r.cloud.position[next++] == Vector3d(1000 - 0.25, 2000 + i, 31) ? 1u : 0u;
  CHECK(right == r.cloud.size());
  text.replace(text.find("\n100000 0.25"), 12, "\n100000 oops");
  CHECK_THROWS_WITH(read(text), Contains("line 100011: expected 4 numbers") && Contains("oops"));
}

TEST_CASE("ptx: what is no grid is refused with its line") {
  CHECK_THROWS_WITH(read(""), Contains("scan.ptx: line 1: the file ends in a grid's header"));
  CHECK_THROWS_WITH(read("2\n"), Contains("line 1: the file ends in a grid's header, expected the number of rows"));
  CHECK_THROWS_WITH(read("2\n2\n0 0\n"),
                    Contains("line 3: expected the scanner's position (3 numbers), found \"0 0\""));
  CHECK_THROWS_WITH(read("-1\n2\n"), Contains("line 1: expected the number of columns of a grid, a whole number"));
  CHECK_THROWS_WITH(read("9223372036854775808\n2\n"), Contains("line 1: expected the number of columns"));
  CHECK_THROWS_WITH(read(header(2, 2) + "1 2 3 0.5\n"),
                    Contains("line 12: the file ends 3 lines before the last of the 4"));
  CHECK_THROWS_WITH(read(header(65536, 65536) + "1 2 3 0.5\n"), Contains("it is cut off"));
  CHECK_THROWS_WITH(read(header(1, 1) + "1 2 3 0.5 6\n"), Contains("line 11: expected 3, 4 or 7 numbers"));
  CHECK_THROWS_WITH(read(header(1, 1) + "0 0 0 0.5\n"), Contains("0 points with a return"));
  CHECK_THROWS_WITH(read(header(0, 0)), Contains("0 points with a return"));
}

TEST_CASE("ptx: a header is recognised") {
  const std::string text = header(3, 4);
  CHECK(recognises_ptx(text.data(), text.size()));
  CHECK_FALSE(recognises_ptx(text.data(), 20));
  const std::string table = "3\n1 2 3\n4 5 6\n7 8 9\n";
  CHECK_FALSE(recognises_ptx(table.data(), table.size()));
}
