#include "host/cloud/readers/las_header.h"
#include "host/error.h"
#include "tests/support/las_bytes.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Matchers::Contains;

namespace {

LasFile some_points(unsigned format = 1, unsigned minor = 2) {
  LasFile file;
  file.format = format;
  file.minor = minor;
  file.points.resize(3);
  return file;
}

LasHeader header_of(const std::string& bytes) {
  const TemporaryFolder folder;
  const InputFile file(folder.write("scan.las", bytes));
  return read_las_header(file);
}

/// The text of the input error that the bytes must raise.
std::string complaint(const std::string& bytes) {
  try {
    header_of(bytes);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    CHECK_THAT(error.what(), Contains("scan.las: byte "));
    return error.what();
  }
  FAIL("accepted");
  return "";
}

template <class Value>
std::string with(std::string bytes, std::size_t at, Value value) {
  return bytes.replace(at, sizeof value, bytes_of(value));
}

} // namespace

TEST_CASE("las header: where the points are, whatever lies before them") {
  LasFile file = some_points(6, 4);
  file.vlrs = {las_vlr("A", 1, "content"), las_vlr("LASF_Spec", 4, std::string(192, '\0'))};
  file.before_points = "????";
  file.evlrs = {las_vlr("late", 9, "extended", true)};
  file.encoding = 16;
  const LasHeader header = header_of(file.bytes());
  CHECK(header.minor == 4);
  CHECK(header.format == 6);
  CHECK(header.header_bytes == 375);
  CHECK(header.vlrs_end == file.points_begin() - 4);
  CHECK(header.points_begin == file.points_begin());
  CHECK(header.record_bytes == 30);
  CHECK(header.points == 3);
  CHECK(header.says_wkt);
  CHECK(header.vlrs_before == 2);
  REQUIRE(header.vlrs.size() == 3);
  REQUIRE(header.find("A", 1) != nullptr);
  CHECK(header.find("A", 1)->bytes == 7);
  CHECK(header.find("A", 2) == nullptr);
  REQUIRE(header.find("late", 9) != nullptr);
  CHECK(header.find("late", 9)->bytes == 8);
  CHECK(header.warnings.empty());
}

TEST_CASE("las header: what is wrong is said with its byte") {
  const std::string good = some_points().bytes();
  CHECK_THAT(complaint("LA"), Contains("byte 0: expected \"LASF\", found \"LA\""));
  CHECK_THAT(complaint(good.substr(0, 226)), Contains("byte 226: the file ends within its header"));
  CHECK_THAT(complaint(with<std::uint8_t>(good, 24, 2)), Contains("byte 24: version 2.2, expected 1.0 to 1.4"));
  CHECK_THAT(complaint(with<std::uint16_t>(good, 94, 100)), Contains("byte 94: a header of 100 bytes"));
  CHECK_THAT(complaint(with<std::uint32_t>(good, 96, 200)), Contains("byte 96: the points begin at byte 200"));
  CHECK_THAT(complaint(with<std::uint32_t>(good, 96, 4000000000u)), Contains("byte 96"));
  CHECK_THAT(complaint(with<std::uint8_t>(good, 104, 11)), Contains("byte 104: point format 11, expected 0 to 10"));
  CHECK_THAT(complaint(with<std::uint8_t>(good, 104, 0x81)),
             Contains("compressed (LAZ)") && Contains("scripts/import"));
  CHECK_THAT(complaint(with<std::uint16_t>(good, 105, 27)), Contains("byte 105: records of 27 bytes, expected 28"));
  CHECK_THAT(complaint(with(good, 131, 0.0)), Contains("byte 131: a scale of 0"));
  CHECK_THAT(complaint(with(good, 139, std::nan(""))), Contains("byte 139: a scale of"));
  CHECK_THAT(complaint(with(good, 171, HUGE_VAL)), Contains("byte 171: an offset"));
}

TEST_CASE("las header: counts that the file can not hold") {
  const LasFile old = some_points(), wide = some_points(6, 4);
  CHECK_THAT(complaint(with<std::uint32_t>(old.bytes(), 107, 4)),
             Contains("byte 107: the header counts 4 points of 28 bytes from byte 227 on, the file has room for 3"));
  CHECK_THAT(complaint(with<std::uint32_t>(old.bytes(), 107, 4294967295u)), Contains("4294967295 points"));
  CHECK_THAT(complaint(with<std::uint32_t>(old.bytes(), 107, 0)),
             Contains("byte 107: the header counts 0 points, though the file has room for 3"));
  LasFile none = old;
  none.points.clear();
  CHECK_THAT(complaint(none.bytes()), Contains("the cloud is empty"));
  for (const std::uint64_t count : {std::uint64_t{1} << 31, std::uint64_t{1} << 63, ~std::uint64_t{0}})
    CHECK_THAT(complaint(with(wide.bytes(), 247, count)),
               Contains("byte 247: the header counts " + std::to_string(count)));
}

TEST_CASE("las header: odd variable length records do not keep anybody from the points") {
  LasFile file = some_points();
  file.vlrs = {las_vlr("A", 1, "content")};
  const std::string good = file.bytes();
  for (const std::string& bytes :
       {with<std::uint32_t>(good, 100, 4294967295u), with<std::uint16_t>(good, 227 + 20, 60000)}) {
    const LasHeader header = header_of(bytes);
    CHECK(header.points == 3);
    REQUIRE(header.warnings.size() == 1);
    CHECK_THAT(header.warnings[0], Contains("variable length records"));
  }
  // Places behind the end of the file, and lengths of nearly 2^64.
  file = some_points(6, 4);
  file.evlrs = {las_vlr("late", 9, "extended", true)};
  const std::size_t evlr = file.points_begin() + 3 * 30;
  for (const std::string& bytes : {with<std::uint64_t>(file.bytes(), 235, ~std::uint64_t{0}),
                                   with<std::uint64_t>(file.bytes(), evlr + 20, ~std::uint64_t{0} - 5)}) {
    const LasHeader header = header_of(bytes);
    CHECK(header.vlrs.empty());
    CHECK(header.warnings.size() == 1);
  }
}

TEST_CASE("las header: room for points that are not counted is told") {
  LasFile file = some_points();
  file.count = 2;
  const LasHeader header = header_of(file.bytes());
  CHECK(header.points == 2);
  REQUIRE(header.warnings.size() == 1);
  CHECK_THAT(header.warnings[0], Contains("room for 3 points"));
}
