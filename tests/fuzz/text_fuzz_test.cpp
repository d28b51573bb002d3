/// Damaged tables and grids of points.
#include "host/cloud/readers/ptx.h"
#include "host/cloud/readers/text.h"
#include "tests/support/damaged.h"

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A line of text takes two bytes at least where it is a point: "," and its end.
constexpr double line_bytes = 2;

std::vector<std::string> tables() {
  std::string plain = "# comment\n", named = "\"X\";\"Y\";\"Z\";\"R\";\"G\";\"B\";Class\r\n", pts = "3\n", colmap;
  for (int i = 0; i < 12; ++i) {
    const std::string k = std::to_string(i);
    plain += k + ".5 -1e3 7." + k + " 0 0.6 0.8 255 128 " + k + "\n";
    named += k + ",5;2,25;" + k + ";1;2;3;wall\r\n";
    pts += k + " 2 3 -" + k + " 10 20 30\n" + (i == 5 ? "6\n" : "");
    colmap += std::to_string(100 + i) + " 0.1 0.2 " + k + " 87 65 44 1.07 14 2239 15 2023" +
              (i % 2 == 0 ? "" : " 1 2") + "\n";
  }
  return {plain, named, pts, colmap};
}

std::string grids() {
  std::string text;
  for (const char* move : {"500100.25 4000050.5 12.125", "1 2 3"}) {
    text += std::string("3\n2\n") + move + "\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" + move + " 1\n";
    for (int i = 0; i < 6; ++i)
      text += i % 3 == 2 ? "0 0 0 0.5 0 0 0\n" : std::to_string(i) + ".25 1 -2 0.75 10 20 30\n";
  }
  return text;
}

} // namespace

TEST_CASE("text fuzz: truncation") {
  for (const std::string& seed : tables()) {
    const std::size_t clouds = count_clouds_of_truncations(read_text, seed, line_bytes);
    CHECK(clouds > 20); // text may end anywhere between two lines, and within a last number
  }
  // A grid that lacks a line is refused: only the first of the two, or the last number cut, may pass.
  const std::size_t clouds = count_clouds_of_truncations(read_ptx, grids(), line_bytes);
  CHECK(clouds < 10);
}

TEST_CASE("text fuzz: thousands of mutations") {
  for (const std::string& seed : tables()) {
    // Both outcomes must have been met, else the fuzz tests one half of the reader only.
    const std::size_t clouds = count_clouds_of_mutations(read_text, seed, line_bytes, 2000);
    CHECK(clouds > 20);
    CHECK(clouds < 1980);
  }
  const std::size_t clouds = count_clouds_of_mutations(read_ptx, grids(), line_bytes, 2000);
  CHECK(clouds > 20);
  CHECK(clouds < 1980);
}

TEST_CASE("text fuzz: counts that no file can hold") {
  const TemporaryFolder folder;
  for (const char* count : {"0", "-1", "2147483648", "4294967297", "9223372036854775808", "1e30", "nan"}) {
    INFO(count);
    const std::string table = std::string(count) + "\n1 2 3\n4 5 6\n";
    survives(read_text, folder.write("cloud.pts", table), table.size(), line_bytes);
    std::string text = grids();
    survives(read_ptx, folder.write("cloud.ptx", text.replace(0, 1, count)), text.size(), line_bytes);
    text = grids();
    survives(read_ptx, folder.write("cloud.ptx", text.replace(2, 1, count)), text.size(), line_bytes);
  }
}
