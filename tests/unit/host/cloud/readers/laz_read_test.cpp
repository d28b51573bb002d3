#include "host/cloud/readers/las_read.h"
#include "host/error.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

std::string changed(std::string bytes, std::size_t place, const std::string& with) {
  return bytes.replace(place, with.size(), with);
}

} // namespace

TEST_CASE("laz: the points are those of the uncompressed file, in all their fields") {
  const TemporaryFolder folder;
  for (const LazSample& sample : laz_samples()) {
    INFO("point format " << sample.format);
    CloudReport packed_report, plain_report;
    const PointCloud packed = read_las(folder.write("a.laz", laz_file(sample, true)), {0.0, {}, true}, packed_report);
    const PointCloud plain = read_las(folder.write("a.las", laz_file(sample, false)), {0.0, {}, true}, plain_report);
    REQUIRE(packed.size() == laz_points);
    CHECK(packed.position == plain.position);
    CHECK(packed.position[1] == Eigen::Vector3d(1007 * 0.001 + 1000.0, -497 * 0.001 + 1000.0, 13 * 0.001 + 1000.0));
    CHECK(packed.colour == plain.colour);
    REQUIRE(packed.fields.size() == plain.fields.size());
    CHECK(packed.fields.size() > 12);
    for (std::size_t f = 0; f < packed.fields.size(); ++f) {
      INFO(packed.fields[f].info.name);
      CHECK(packed.fields[f].values == plain.fields[f].values);
    }
    CHECK(packed_report.format == (sample.format == 3 ? "LAZ 1.2, point format 3" : "LAZ 1.4, point format 8"));
    CHECK(packed_report.up == Eigen::Vector3d(0, 0, 1));
  }
}

TEST_CASE("laz: what is not understood names the command that converts it") {
  const TemporaryFolder folder;
  CloudReport report;
  const LazSample& sample = laz_samples().front();
  const std::string whole = laz_file(sample, true);
  const std::size_t description = 227 + 54;
  const auto reading = [&](const std::string& bytes) { return read_las(folder.write("a.laz", bytes), {}, report); };
  const std::string command = "`scripts/import " + folder.file("a.laz") + " OUT.ply`";
  CHECK_THROWS_WITH(reading(changed(whole, description, "\5")), Contains("kind 5") && Contains(command));
  CHECK_THROWS_WITH(reading(changed(whole, description + 34 + 4, "\1")),
                    Contains("type 6, version 1") && Contains(command));
  CHECK_THROWS_WITH(reading(changed(whole, 227 + 2, "nothing")), Contains("too short") && Contains(command));
}

TEST_CASE("laz: damage is named with its byte") {
  const TemporaryFolder folder;
  for (const LazSample& sample : laz_samples()) {
    INFO("point format " << sample.format);
    CloudReport report;
    const std::string whole = laz_file(sample, true);
    const std::size_t begin = whole.size() - from_hex(sample.table).size() - from_hex(sample.chunk).size() - 8;
    const auto reading = [&](const std::string& bytes) { return read_las(folder.write("a.laz", bytes), {}, report); };
    CHECK_THROWS_WITH(reading(whole.substr(0, begin + 100)),
                      Contains("byte " + std::to_string(begin)) && Contains("table of chunks"));
    CHECK_THROWS_WITH(reading(changed(whole, sample.format < 6 ? 107 : 247, "\xff\xff\xff\x0f")),
                      Contains("byte ") && Contains("268435455 compressed points"));
    const std::string table = std::to_string(whole.size() - from_hex(sample.table).size());
    CHECK_THROWS_WITH(reading(changed(whole, whole.size() - from_hex(sample.table).size() + 4, std::string(4, '\0'))),
                      Contains("a table of 0 chunks, expected 1"));
  }
}
