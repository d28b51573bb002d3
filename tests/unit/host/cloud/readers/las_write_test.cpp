#include "host/cloud/readers/las_header.h"
#include "host/cloud/readers/las_read.h"
#include "host/cloud/readers/las_write.h"
#include "host/error.h"
#include "tests/support/las_bytes.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Matchers::Contains;
using Eigen::Vector3f;

namespace {

LasFile sample(unsigned format, unsigned minor) {
  LasFile file;
  file.format = format;
  file.minor = minor;
  for (std::uint16_t i = 0; i < 5; ++i) {
    LasPoint p;
    p.position = {i, 2 * i, -i};
    p.intensity = static_cast<std::uint16_t>(1000 + i);
    p.colour = {static_cast<std::uint16_t>(257 * i), 65535, 1};
    file.points.push_back(p);
  }
  return file;
}

std::vector<Field> two_columns() {
  return {{{"radiosity_r", FieldType::f32, 1.0, 0.0}, {0.25, 1e-3, 3.5, HUGE_VAL, -1.0}},
          {{"sky", FieldType::u8, 1.0 / 255.0, 0.0}, {0.0, 0.2, 1.0, 7.0, std::nan("")}}};
}

PointCloud read_all(const std::string& path) {
  CloudReport report;
  PointCloud cloud = read_las(path, {0.0, {}, true}, report);
  CHECK(report.warnings.empty());
  return cloud;
}

const std::vector<double>& values_of(const PointCloud& cloud, const std::string& name) {
  for (const Field& field : cloud.fields)
    if (field.info.name == name) return field.values;
  FAIL("no field " << name);
  return cloud.fields[0].values;
}

/// The bytes of each point record that the format defines.
std::vector<std::string> records_of(const std::string& path) {
  const InputFile file(path);
  const LasHeader header = read_las_header(file);
  std::vector<std::string> records;
  for (std::size_t i = 0; i < header.points; ++i)
    records.push_back(
        contents(path).substr(header.points_begin + i * header.record_bytes, las_record_bytes(header.format)));
  return records;
}

void check_columns(const PointCloud& cloud) {
  CHECK(values_of(cloud, "radiosity_r") == std::vector<double>{0.25, static_cast<double>(1e-3f), 3.5, HUGE_VAL, -1.0});
  const std::vector<double>& sky = values_of(cloud, "sky");
  for (std::size_t i = 0; i < 5; ++i) // in steps of 1/255, which 0.2 is 51 of, up to 255 of them
    CHECK(sky[i] == Approx(std::vector<double>{0.0, 0.2, 1.0, 1.0, 0.0}[i]).margin(1e-12));
}

} // namespace

TEST_CASE("las write: every format keeps its records and gets columns that are read back") {
  const TemporaryFolder folder;
  for (unsigned format = 0; format <= 10; ++format) {
    INFO("point format " << format);
    LasFile file = sample(format, format <= 3 ? 2 : format <= 5 ? 3 : 4);
    file.vlrs = {las_vlr("LASF_Projection", 2112, "PROJCS[\"somewhere\"]")};
    file.before_points = "padding";
    const std::string source = folder.write("source.las", file.bytes()), output = folder.file("out.las");
    write_las_with_columns(source, output, two_columns(), {});
    CHECK(records_of(output) == records_of(source));
    const InputFile opened(output);
    const LasHeader header = read_las_header(opened);
    CHECK(header.minor == static_cast<int>(file.minor));
    CHECK(header.format == format);
    CHECK(header.record_bytes == file.record_bytes() + 5);
    REQUIRE(header.vlrs.size() == 2);
    CHECK(contents(output).substr(header.vlrs[0].begin, file.vlrs[0].size()) == file.vlrs[0]);
    CHECK(contents(output).substr(header.points_begin - 7, 7) == "padding");
    check_columns(read_all(output));
  }
}

TEST_CASE("las write: extra bytes that are there stay and a second run writes over the first") {
  const TemporaryFolder folder;
  LasFile file = sample(1, 2);
  // One described value of two bytes, and three bytes that nobody describes.
  file.vlrs = {las_vlr("first", 1, "a"), las_vlr("LASF_Spec", 4, las_extra_entry_bytes("Deviation", 3)),
               las_vlr("last", 2, "b")};
  for (std::uint16_t i = 0; i < 5; ++i)
    file.extra.push_back(bytes_of(i) + "xyz");
  const std::string source = folder.write("source.las", file.bytes()), output = folder.file("out.las");
  write_las_with_columns(source, output, two_columns(), {});
  const std::string once = contents(output);
  write_las_with_columns(output, output, two_columns(), {}); // over itself, too
  CHECK(contents(output) == once);
  CHECK(folder.entries() == 2);
  const PointCloud cloud = read_all(output);
  check_columns(cloud);
  CHECK(values_of(cloud, "Deviation") == std::vector<double>{0, 1, 2, 3, 4});
  CHECK(values_of(cloud, "extra_bytes1") == std::vector<double>(5, 'y'));
  CHECK_THAT(once, Contains("an extra dimension")); // the description of the old entry
  CHECK_THROWS_WITH(
      write_las_with_columns(output, output, {{{"sky", FieldType::f64, 1.0, 0.0}, std::vector<double>(5)}}, {}),
      Contains("has extra bytes \"sky\" of another type already"));
  CHECK(contents(output) == once);
}

TEST_CASE("las write: what lies behind the points moves with them") {
  const TemporaryFolder folder;
  LasFile file = sample(6, 4);
  for (int i = 0; i < 5; ++i)
    file.extra.push_back(std::string(1, static_cast<char>('a' + i)));
  file.evlrs = {las_vlr("late", 9, "extended", true), las_vlr("LASF_Spec", 4, las_extra_entry_bytes("Letter", 1), true),
                las_vlr("later", 10, "end", true)};
  const std::string source = folder.write("source.las", file.bytes()), output = folder.file("out.las");
  write_las_with_columns(source, output, two_columns(), {});
  const PointCloud cloud = read_all(output);
  check_columns(cloud);
  CHECK(values_of(cloud, "Letter") == std::vector<double>{'a', 'b', 'c', 'd', 'e'});
  const InputFile opened(output);
  const LasHeader header = read_las_header(opened);
  REQUIRE(header.vlrs.size() == 4); // one more, before the points
  CHECK(header.vlrs_before == 1);
  CHECK(header.vlrs[1].user == "late");
  CHECK(header.vlrs[2].id == 7); // superseded
  CHECK(header.vlrs[3].user == "later");
  CHECK(contents(output).substr(header.vlrs[3].data) == "end");
}

TEST_CASE("las write: compressed points come out plain") {
  const TemporaryFolder folder;
  for (const LazSample& sample : laz_samples()) {
    INFO("point format " << sample.format);
    const std::string packed = folder.write("a.laz", laz_file(sample, true));
    const std::string plain = folder.write("a.las", laz_file(sample, false)), output = folder.file("out.las");
    const std::vector<Field> columns{{{"sky", FieldType::f32, 1.0, 0.0}, std::vector<double>(laz_points, 0.5)}};
    CHECK(las_holds_colour(packed));
    write_las_with_columns(packed, output, columns, {});
    CHECK(records_of(output) == records_of(plain));
    CHECK(values_of(read_all(output), "sky") == std::vector<double>(laz_points, 0.5));
    CHECK_THAT(contents(output), !Contains("laszip encoded"));
  }
}

TEST_CASE("las write: colours replace the file's where the format has any") {
  const TemporaryFolder folder;
  const float nan = std::nanf("");
  const std::vector<Vector3f> colours{{0, 0.5f, 1}, {nan, 0, 0}, {-1, 2, 1}, {0.25f, 0.25f, 0.25f}, {1, 1, 1}};
  const std::string source = folder.write("source.las", sample(2, 2).bytes()), output = folder.file("out.las");
  CHECK(las_holds_colour(source));
  write_las_with_columns(source, output, {}, colours);
  const PointCloud cloud = read_all(output), old = read_all(source);
  CHECK(values_of(cloud, "red") == std::vector<double>{0, 257, 0, 16384, 65535});
  CHECK(values_of(cloud, "green") == std::vector<double>{32768, 65535, 65535, 16384, 65535});
  CHECK(values_of(cloud, "blue") == std::vector<double>{65535, 1, 65535, 16384, 65535});
  CHECK(values_of(cloud, "intensity") == values_of(old, "intensity"));
  CHECK(contents(output).size() == contents(source).size()); // nothing was added
  const std::string grey = folder.write("grey.las", sample(1, 2).bytes());
  CHECK_FALSE(las_holds_colour(grey));
  write_las_with_columns(grey, output, {}, colours);
  CHECK(contents(output) == contents(grey));
}

TEST_CASE("las write: integers are rounded and clamped") {
  const TemporaryFolder folder;
  const std::string source = folder.write("source.las", sample(0, 2).bytes()), output = folder.file("out.las");
  const std::vector<double> values{1e30, -1e30, 2.5, -2.4, std::nan("")};
  const std::vector<FieldType> types{FieldType::i8,  FieldType::u8,  FieldType::i16, FieldType::u16, FieldType::i32,
                                     FieldType::u32, FieldType::i64, FieldType::u64, FieldType::f64};
  std::vector<Field> columns;
  for (std::size_t t = 0; t < types.size(); ++t)
    columns.push_back({{"column" + std::to_string(t), types[t], 1.0, 0.0}, values});
  write_las_with_columns(source, output, columns, {});
  const PointCloud cloud = read_all(output);
  CHECK(values_of(cloud, "column0") == std::vector<double>{127, -128, 3, -2, 0});
  CHECK(values_of(cloud, "column1") == std::vector<double>{255, 0, 3, 0, 0});
  CHECK(values_of(cloud, "column5") == std::vector<double>{4294967295.0, 0, 3, 0, 0});
  CHECK(values_of(cloud, "column6") == std::vector<double>{std::ldexp(1.0, 63), -std::ldexp(1.0, 63), 3, -2, 0});
  CHECK(values_of(cloud, "column7") == std::vector<double>{std::ldexp(1.0, 64), 0, 3, 0, 0});
  CHECK(values_of(cloud, "column8")[3] == -2.4);
}

TEST_CASE("las write: what can not be written leaves an older file whole") {
  const TemporaryFolder folder;
  const std::string source = folder.write("source.las", sample(0, 2).bytes()), output = folder.write("out.las", "old");
  const std::vector<Field> many(400, {{"c", FieldType::u8, 1.0, 0.0}, std::vector<double>(5)});
  CHECK_THROWS_WITH(write_las_with_columns(source, output, many, {}), Contains("no room for 400 more values"));
  CHECK_THROWS_WITH(write_las_with_columns(source, output, {{{"c", FieldType::u8, 1.0, 0.0}, {1}}}, {}),
                    Contains("1 values for 5 points"));
  CHECK_THROWS_WITH(
      write_las_with_columns(source, output, {{{"", FieldType::u8, 1.0, 0.0}, std::vector<double>(5)}}, {}),
      Contains("no name"));
  CHECK_THROWS_AS(write_las_with_columns(folder.file("absent.las"), output, {}, {}), Error);
  CHECK(contents(output) == "old");
}
