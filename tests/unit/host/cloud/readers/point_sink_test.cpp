/// What rows of values become.
#include "host/cloud/readers/point_sink.h"
#include "host/error.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

using namespace pointgi;
using Catch::Contains;
using Eigen::Vector3f;

namespace {

using Rows = std::vector<std::vector<double>>;

/// A cloud of the named fields, all of one type but x, y and z, which are 0.
PointCloud cloud_of(const std::vector<std::string>& names, FieldType type, const Rows& rows, CloudReport& report) {
  std::vector<FieldInfo> fields{{"x", FieldType::f64, 1, 0}, {"y", FieldType::f64, 1, 0}, {"z", FieldType::f64, 1, 0}};
  for (const std::string& name : names)
    fields.push_back({name, type, 1.0, 0.0});
  PointSink sink(plan_fields(std::move(fields), {}, "cloud.ply", "line 1", report), rows.size(), "cloud.ply");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double> row{0.0, 0.0, 0.0};
    row.insert(row.end(), rows[i].begin(), rows[i].end());
    sink.put(i, row.data());
  }
  report.notes.clear(); // those of the plan have a test of their own
  return sink.finish(report);
}

PointCloud colours_of(FieldType type, const Rows& rows, CloudReport& report) {
  return cloud_of({"red", "green", "blue"}, type, rows, report);
}

double bits_as_float(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

const float rounding = 1e-6f; // one multiplication in float, of values up to 1

bool near(const Vector3f& a, const Vector3f& b) {
  return (a - b).cwiseAbs().maxCoeff() < rounding;
}

} // namespace

TEST_CASE("sink: the type and nearly all points decide the range of colours", "[fields]") {
  struct Case {
    FieldType type;
    double white, odd; ///< the channel of one point of 2000
    std::size_t notes, warnings;
  };
  for (const Case& c : {Case{FieldType::u8, 255, 255, 0, 0}, Case{FieldType::u16, 65535, 65535, 0, 0},
                        Case{FieldType::u16, 255, 255, 1, 0},   // 8 bits in 16, as PDAL writes them
                        Case{FieldType::u16, 255, 65535, 1, 1}, // all but one
                        Case{FieldType::i32, 255, 255, 0, 0},   // as everybody means them
                        Case{FieldType::f32, 1, 1, 0, 0}, Case{FieldType::f32, 1, 1.0005, 0, 0},
                        Case{FieldType::f32, 1, 1.02, 0, 1}, Case{FieldType::f32, 1, 300, 0, 1},
                        Case{FieldType::f64, 255, 255, 1, 0}, Case{FieldType::f32, 65535, 65535, 1, 0}}) {
    INFO(name_of(c.type) << ", white is " << c.white << ", one is " << c.odd);
    Rows rows(2000, {c.white, 0.2 * c.white, 0.0});
    rows[7] = {c.odd, 0.2 * c.white, 0.0};
    CloudReport report;
    const PointCloud cloud = colours_of(c.type, rows, report);
    CHECK(near(cloud.colour[0], {1.0f, 0.2f, 0.0f}));
    CHECK(near(cloud.colour[7], {1.0f, 0.2f, 0.0f}));
    CHECK(report.notes.size() == c.notes);
    CHECK(report.warnings.size() == c.warnings);
    if (c.warnings > 0) CHECK_THAT(report.warnings[0], Contains("1 of 2000 points"));
  }
}

TEST_CASE("sink: colours of a few points more than a thousandth count", "[fields]") {
  Rows rows(2000, {100, 100, 100});
  for (std::size_t i = 0; i < 3; ++i)
    rows[i] = {60000, 0, 0};
  CloudReport report;
  CHECK(near(colours_of(FieldType::u16, rows, report).colour[10], Vector3f::Constant(100.0f / 65535.0f)));
}

TEST_CASE("sink: packed colours as integers, as floats and as the bits of floats", "[fields]") {
  const Vector3f brick(190 / 255.0f, 80 / 255.0f, 50 / 255.0f);
  CloudReport report;
  CHECK(near(cloud_of({"rgb"}, FieldType::f32, {{bits_as_float(0x00be5032)}}, report).colour[0], brick));
  CHECK(near(cloud_of({"rgb"}, FieldType::f32, {{12472370.0}}, report).colour[0], brick));
  CHECK(near(cloud_of({"rgba"}, FieldType::u32, {{4290662450.0}}, report).colour[0], brick)); // 0xff above
  CHECK(near(cloud_of({"rgb"}, FieldType::i32, {{-4304846.0}}, report).colour[0], brick));    // the same bits
  CHECK(near(cloud_of({"rgb"}, FieldType::f32, {{0.0}}, report).colour[0], Vector3f::Zero()));
  // With 0xff above and less than 128 of red it is a number yet.
  CHECK(near(cloud_of({"rgb"}, FieldType::f32, {{bits_as_float(0xff285032)}}, report).colour[0],
             {40 / 255.0f, 80 / 255.0f, 50 / 255.0f}));
  CHECK(report.warnings.empty());
}

TEST_CASE("sink: normals that are missing become zero, and no array where all are", "[fields]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CloudReport report;
  const PointCloud cloud = cloud_of({"nx", "ny", "nz"}, FieldType::f32,
                                    {{0, 0, 2}, {0, 0, 0}, {nan, 0, 1}, {0, HUGE_VAL, 0}, {1e-42, 0, 0}}, report);
  REQUIRE(cloud.normal.size() == 5);
  CHECK(cloud.normal[0] == Vector3f(0, 0, 2)); // any length is kept
  for (std::size_t i = 1; i < 5; ++i)
    CHECK(cloud.normal[i] == Vector3f::Zero());
  CHECK(report.notes.empty());

  CHECK(cloud_of({"nx", "ny", "nz"}, FieldType::f32, {{0, 0, 0}, {nan, nan, nan}}, report).normal.empty());
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("normals are all zero"));
}

TEST_CASE("sink: intensity alone is kept as a field", "[fields]") {
  CloudReport report;
  const PointCloud cloud = cloud_of({"scalar_Intensity"}, FieldType::u16, {{17}, {40000}}, report);
  REQUIRE(cloud.fields.size() == 1);
  CHECK(cloud.fields[0].info.name == "scalar_Intensity");
  CHECK(cloud.fields[0].values == std::vector<double>{17, 40000});
  CHECK(cloud.colour.empty());
  CHECK(report.points_in_file == 2);
}
