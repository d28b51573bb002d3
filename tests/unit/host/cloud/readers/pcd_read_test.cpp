#include "host/cloud/readers/pcd_read.h"
#include "host/error.h"
#include "tests/support/lzf_bytes.h"
#include "tests/support/ply_bytes.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

struct Result {
  PointCloud cloud;
  CloudReport report;
};

Result read(const std::string& bytes, const ReadRequest& request = {}) {
  const TemporaryFolder folder;
  Result result;
  result.cloud = read_pcd(folder.write("scan.pcd", bytes), request, result.report);
  return result;
}

/// The text of the input error that the bytes must raise.
std::string complaint(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    CHECK_THAT(error.what(), Contains("scan.pcd: "));
    return error.what();
  }
  FAIL("accepted: " << bytes.substr(0, 300));
  return "";
}

const std::vector<double>& values_of(const PointCloud& cloud, const std::string& name) {
  for (const Field& field : cloud.fields)
    if (field.info.name == name) return field.values;
  FAIL("no field " << name);
  return cloud.fields[0].values;
}

bool mentions(const std::vector<std::string>& sentences, const std::string& words) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(words) != std::string::npos; });
}

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, const std::string& size, const std::string& data,
                   const std::string& viewpoint = "0 0 0 1 0 0 0") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " +
         types + "\nCOUNT " + counts + "\n" + size + "VIEWPOINT " + viewpoint + "\nDATA " + data + "\n";
}

std::string count(int points) {
  return "WIDTH " + std::to_string(points) + "\nHEIGHT 1\nPOINTS " + std::to_string(points) + "\n";
}

/// A float whose bits are a colour.
float packed(std::uint32_t colour) {
  float value;
  std::memcpy(&value, &colour, sizeof value);
  return value;
}

std::string compressed_block(const std::string& columns) {
  const std::string packed_bytes = lzf_compressed(columns);
  return bytes_of(static_cast<std::uint32_t>(packed_bytes.size())) +
         bytes_of(static_cast<std::uint32_t>(columns.size())) + packed_bytes;
}

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST_CASE("pcd read: the three kinds of data hold the same points") {
  // A field of every kind, padding, and a field of two values.
  const std::string fields = "x y z _ intensity label time half", sizes = "8 4 4 1 2 4 8 1", types = "F F F U U I U I",
                    counts = "1 1 1 3 1 1 1 2";
  std::string text, records;
  std::vector<std::string> columns(8);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<std::string> values{bytes_of(0.5 * i),
                                          bytes_of(-0.25f * static_cast<float>(i)),
                                          bytes_of(3.0f),
                                          "\1\2\3",
                                          bytes_of(static_cast<std::uint16_t>(i * 60)),
                                          bytes_of<std::int32_t>(-i),
                                          bytes_of(std::uint64_t{1} << 40),
                                          std::string(1, static_cast<char>(i % 100)) + "\xff"};
    for (std::size_t f = 0; f < values.size(); ++f) {
      records += values[f];
      columns[f] += values[f];
    }
    text += std::to_string(0.5 * i) + "  " + std::to_string(-0.25 * i) + "\t3 1 2 3 " + std::to_string(i * 60) + " " +
            std::to_string(-i) + " 1099511627776 " + std::to_string(i % 100) + " -1\r\n";
  }
  std::string block;
  for (const std::string& column : columns)
    block += column;
  const std::vector<std::pair<std::string, std::string>> files{
      {"ascii", text}, {"binary", records}, {"binary_compressed", compressed_block(block)}};
  for (const auto& [data, body] : files) {
    INFO(data);
    const auto [cloud, report] = read(header(fields, sizes, types, counts, count(1000), data) + body,
                                      {0.0, {"intensity", "label", "time", "half0", "half1"}, false});
    CHECK(report.format == "PCD " + data);
    CHECK(report.points_in_file == 1000);
    REQUIRE(cloud.size() == 1000);
    CHECK(cloud.position[999] == Vector3d(499.5, -249.75, 3.0));
    CHECK(values_of(cloud, "intensity")[999] == 59940.0);
    CHECK(values_of(cloud, "label")[999] == -999.0);
    CHECK(values_of(cloud, "time")[999] == 1099511627776.0);
    CHECK(values_of(cloud, "half0")[999] == 99.0);
    CHECK(values_of(cloud, "half1")[999] == -1.0);
    CHECK(cloud.stations.empty()); // a viewpoint of 0 0 0 says nothing
    CHECK_FALSE(report.up.has_value());
    CHECK(report.warnings.empty());
  }
}

TEST_CASE("pcd read: colours packed into floats and integers") {
  const std::uint32_t orange = 0xff8000, opaque = 0xff8040c0; // the upper byte is opacity: as a float it is no number
  struct Kind {
    std::string name, type;
    std::string in_bytes, in_text;
    Vector3f colour;
  };
  const Vector3f of_orange(1.0f, 128 / 255.0f, 0.0f), of_opaque(128 / 255.0f, 64 / 255.0f, 192 / 255.0f);
  const std::vector<Kind> kinds{{"rgb", "F", bytes_of(packed(orange)), "2.34639693e-38", of_orange},
                                {"rgb", "F", bytes_of(packed(orange)), "16744448", of_orange},
                                {"rgba", "F", bytes_of(opaque), "4286595264", of_opaque},
                                {"rgba", "U", bytes_of(opaque), "4286595264", of_opaque},
                                {"rgb", "I", bytes_of(opaque), "-8372032", of_opaque}};
  for (const Kind& kind : kinds) {
    INFO(kind.name << " " << kind.type << " " << kind.in_text);
    for (const bool binary : {false, true}) {
      const std::string head = header("x y z " + kind.name, "4 4 4 4", "F F F " + kind.type, "1 1 1 1", count(1),
                                      binary ? "binary" : "ascii");
      const std::string body =
          binary ? bytes_of(1.0f) + bytes_of(2.0f) + bytes_of(3.0f) + kind.in_bytes : "1 2 3 " + kind.in_text + "\n";
      const PointCloud cloud = read(head + body).cloud;
      REQUIRE(cloud.colour.size() == 1);
      CHECK((cloud.colour[0] - kind.colour).norm() < 1e-6f); // rounding of floats
    }
  }
  const PointCloud triple =
      read(header("xyz rgb normal", "4 1 4", "F U F", "3 3 3", count(1), "binary") + bytes_of(1.0f) + bytes_of(2.0f) +
           bytes_of(3.0f) + "\xff\x80\x01" + bytes_of(0.0f) + bytes_of(0.0f) + bytes_of(1.0f))
          .cloud;
  CHECK(triple.position[0] == Vector3d(1, 2, 3));
  CHECK((triple.colour.at(0) - Vector3f(1.0f, 128 / 255.0f, 1 / 255.0f)).norm() < 1e-6f);
  CHECK(triple.normal.at(0) == Vector3f(0, 0, 1));
}

TEST_CASE("pcd read: an organised cloud keeps its pixels, seen or not") {
  std::string body;
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 3; ++k)
      body += bytes_of(i % 4 == 3 ? not_a_number : static_cast<float>(i + k));
  for (const std::string data : {"binary", "ascii"}) {
    std::string text;
    for (int i = 0; i < 12; ++i)
      text += i % 4 == 3 ? "nan nan NaN\n" : std::to_string(i) + " " + std::to_string(i + 1) + " 7\n";
    const auto [cloud, report] =
        read(header("x y z", "4 4 4", "F F F", "1 1 1", "WIDTH 4\nHEIGHT 3\nPOINTS 12\n", data) +
             (data == "ascii" ? text : body));
    CHECK(report.format == "PCD " + data + ", 4 x 3");
    REQUIRE(cloud.size() == 12);
    CHECK_FALSE(cloud.position[7].allFinite());
    CHECK(cloud.position[8].x() == 8.0);
  }
}

TEST_CASE("pcd read: a viewpoint that is a place is the scanner's") {
  const std::string body = bytes_of(1.0f) + bytes_of(2.0f) + bytes_of(3.0f);
  const auto [cloud, report] =
      read(header("x y z", "4 4 4", "F F F", "1 1 1", count(1), "binary", "1.5 -2 0.25 0.5 0.5 0.5 0.5") + body);
  CHECK(cloud.position[0] == Vector3d(1, 2, 3)); // as stored
  CHECK(cloud.stations == std::vector<Vector3d>{{1.5, -2, 0.25}});
  CHECK(cloud.station == std::vector<std::uint16_t>{0});
  CHECK(report.stations == cloud.stations);
  // A turn alone, as depth cameras write it, names no place; nor does what is no number.
  for (const char* viewpoint : {"0 0 0 0 1 0 0", "nan 0 0 1 0 0 0"})
    CHECK(
        read(header("x y z", "4 4 4", "F F F", "1 1 1", count(1), "binary", viewpoint) + body).cloud.stations.empty());
}

TEST_CASE("pcd read: old and odd headers") {
  // Version .5 had no COUNT; blank lines, comments, CRLF and lower case are no matter; nor are trailing values.
  const auto [cloud, report] =
      read("# .PCD v.5\r\nVERSION .5\r\n\r\n# more\r\ncolumns x y z\r\nWIDTH 2\r\nDATA ascii\r\n\r\n"
           "1 2 3\r\n\r\n4 5 6 7");
  REQUIRE(cloud.size() == 2);
  CHECK(cloud.position[1] == Vector3d(4, 5, 6));
  CHECK(mentions(report.warnings, "1 lines have more values"));
  // POINTS and WIDTH that differ; what follows the points.
  const std::string body(13, '\0');
  const Result odd = read(header("x y z", "1 1 1", "U U U", "1 1 1", "WIDTH 7\nHEIGHT 1\nPOINTS 3\n", "binary") + body);
  CHECK(odd.cloud.size() == 3);
  CHECK(mentions(odd.report.warnings, "WIDTH and HEIGHT make 7"));
  CHECK(mentions(odd.report.warnings, "4 bytes from byte"));
}

TEST_CASE("pcd read: what is wrong is said with its line or byte") {
  CHECK_THAT(complaint("289814.15 4320978.61 170.76\n289814.64 4320978.84 170.76\n"),
             Contains("line 1: expected FIELDS") && Contains("no PCD header"));
  CHECK_THAT(complaint("VERSION 0.7\n"), Contains("line 2: the file ends within its header"));
  CHECK_THAT(complaint("FIELDS x y\nWIDTH 1\nDATA ascii\n1 2\n"), Contains("no property \"z\""));
  CHECK_THAT(complaint("WIDTH 1\nDATA ascii\n1 2 3\n"), Contains("line 2: no line FIELDS"));
  CHECK_THAT(complaint("FIELDS x y z\nDATA ascii\n1 2 3\n"), Contains("neither WIDTH nor POINTS"));
  CHECK_THAT(complaint("FIELDS x y z\nSIZE 4 4\nWIDTH 1\nDATA ascii\n1 2 3\n"),
             Contains("line 2: 2 words, expected 3"));
  CHECK_THAT(complaint("FIELDS x y z\nSIZE 4 4 3\nWIDTH 1\nDATA ascii\n1 2 3\n"), Contains("\"z\" has TYPE"));
  CHECK_THAT(complaint("FIELDS x y z\nWIDTH 1\nDATA binary\n123456789012"), Contains("binary data without lines SIZE"));
  CHECK_THAT(complaint("FIELDS x y z\nCOUNT 1 1 0\nWIDTH 1\nDATA ascii\n1 2 3\n"), Contains("a COUNT of 0"));
  CHECK_THAT(complaint("FIELDS x y z\nVIEWPOINT 1 2\nWIDTH 1\nDATA ascii\n1 2 3\n"), Contains("expected 7 numbers"));
  CHECK_THAT(complaint("FIELDS x y z\nWIDTH 1\nDATA zip\n1 2 3\n"), Contains("line 3: expected DATA ascii"));
  CHECK_THAT(complaint("FIELDS x y z\nWIDTH 2\nDATA ascii\n1 2 3\n4.0 5.0\n"),
             Contains("line 5: 2 values, expected 3"));
  CHECK_THAT(complaint("FIELDS x y z\nWIDTH 2\nDATA ascii\n1 2 3\n4 5 b\n"),
             Contains("line 5: expected a number, found \"b\""));
  CHECK_THAT(complaint("FIELDS x y z\nWIDTH 2\nDATA ascii\n1.000 2.000 3.000\n"),
             Contains("ends after 1 points, expected 2"));
}

TEST_CASE("pcd read: counts that the file can not hold") {
  for (const std::string data : {"ascii", "binary", "binary_compressed"})
    for (const std::string points : {"0", "-1", "2147483648", "9223372036854775808", "18446744073709551616"})
      for (const std::string key : {"WIDTH ", "POINTS "}) {
        INFO(data << " " << key << points);
        const std::string text = header("x y z", "4 4 4", "F F F", "1 1 1", key + points + "\n", data);
        CHECK_THAT(complaint(text + std::string(100, '1')), Contains("line 7: "));
      }
  CHECK_THAT(complaint(header("x y z", "4 4 4", "F F F", "1 1 1", "WIDTH 4294967296\nHEIGHT 4294967296\n", "ascii")),
             Contains("18446744073709551615 points"));
}

TEST_CASE("pcd read: compressed data that are damaged") {
  const std::string head = header("x y z", "4 4 4", "F F F", "1 1 1", count(20), "binary_compressed");
  const std::string good = compressed_block(std::string(240, '\1'));
  const std::size_t begin = head.size();
  CHECK(read(head + good).cloud.size() == 20);
  CHECK_THAT(complaint(head + good.substr(0, 9)), Contains("byte " + std::to_string(begin)) && Contains("truncated"));
  std::string other = good;
  other[4] = '\7';
  CHECK_THAT(complaint(head + other),
             Contains("byte " + std::to_string(begin + 4) + ": 7 bytes of points are announced"));
  other = good;
  other[8] = '\xff';
  CHECK_THAT(complaint(head + other),
             Contains("byte " + std::to_string(begin + 8) + ": the compressed data make no sense"));
  CHECK_THAT(complaint(head + compressed_block(std::string(240, '\1')).replace(0, 1, "\3")),
             Contains("the compressed data"));
  CHECK(read(head + good + std::string(4000, '\0')).report.warnings.empty()); // PCL fills pages
}

TEST_CASE("a line of a PCD header that begins with empty quotes is refused, not read beyond its end") {
  CHECK_THAT(complaint("# .PCD v0.7\nVERSION 0.7\n\"\""), Contains("line 3: expected FIELDS"));
  CHECK_THAT(complaint("# .PCD v0.7\nVERSION 0.7\n\"\" 3\nDATA ascii\n"), Contains("line 3: expected FIELDS"));
}
