#include "host/cloud/readers/las_read.h"
#include "host/error.h"
#include "tests/support/las_bytes.h"
#include "tests/support/temporary_folder.h"
#include <algorithm>
#include <catch2/catch.hpp>

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

Result read(const LasFile& file, const ReadRequest& request = {}) {
  const TemporaryFolder folder;
  Result result;
  result.cloud = read_las(folder.write("scan.las", file.bytes()), request, result.report);
  return result;
}

const std::vector<double>& values_of(const PointCloud& cloud, const std::string& name) {
  for (const Field& field : cloud.fields)
    if (field.info.name == name) return field.values;
  FAIL("no field " << name);
  return cloud.fields[0].values;
}

bool has_field(const PointCloud& cloud, const std::string& name) {
  return std::any_of(cloud.fields.begin(), cloud.fields.end(),
                     [&](const Field& field) { return field.info.name == name; });
}

bool mentions(const std::vector<std::string>& sentences, const std::string& words) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(words) != std::string::npos; });
}

/// Two points whose values differ in every dimension.
LasFile two_points(unsigned format) {
  LasFile file;
  file.format = format;
  file.minor = format <= 3 ? 2 : format <= 5 ? 3 : 4;
  file.scale = {0.01, 0.001, 0.25};
  file.offset = {600000.0, 4000000.0, -10.0};
  LasPoint p;
  p.position = {-2147483647, 5, 41};
  p.intensity = 65535;
  p.return_number = 2;
  p.returns = 5;
  p.classification = 31;
  p.angle = -90;
  p.user_data = 200;
  p.source = 40000;
  p.gps_time = 123456.789;
  p.colour = {65535, 32768, 257};
  p.nir = 999;
  file.points = {p, {}};
  file.points[1].position = {7, -8, 9};
  file.points[1].gps_time = -1.5;
  return file;
}

/// Degrees that say so, or do not, and heights in metres.
LasFile in_degrees() {
  LasFile file;
  file.scale = {1e-7, 1e-7, 0.01};
  for (int i = 0; i < 100; ++i) {
    LasPoint p;
    p.position = {100000000 + 10000 * (i % 10), 450000000 + 10000 * (i / 10), 50000 + i};
    file.points.push_back(p);
  }
  return file;
}

std::string geo_keys(std::uint16_t key, std::uint16_t value) {
  std::string bytes;
  for (const std::uint16_t number : std::array<std::uint16_t, 8>{1, 1, 0, 1, key, 0, 1, value})
    bytes += bytes_of(number);
  return las_vlr("LASF_Projection", 34735, bytes);
}

} // namespace

TEST_CASE("las read: every point format has its dimensions at their places") {
  for (unsigned format = 0; format <= 10; ++format) {
    INFO("point format " << format);
    const auto [cloud, report] = read(two_points(format), {0.0, {}, true});
    CHECK(report.format == "LAS 1." +
                               std::to_string(format <= 3   ? 2
                                              : format <= 5 ? 3
                                                            : 4) +
                               ", point format " + std::to_string(format));
    REQUIRE(cloud.size() == 2);
    // Exactly: integer times scale, rounded, plus offset, rounded, which is how others compute it.
    CHECK(cloud.position[0] == Vector3d(-2147483647 * 0.01 + 600000.0, 5 * 0.001 + 4000000.0, 41 * 0.25 - 10.0));
    CHECK(cloud.position[1] == Vector3d(7 * 0.01 + 600000.0, -8 * 0.001 + 4000000.0, 9 * 0.25 - 10.0));
    CHECK(values_of(cloud, "intensity") == std::vector<double>{65535, 0});
    CHECK(values_of(cloud, "return_number") == std::vector<double>{2, 1});
    CHECK(values_of(cloud, "number_of_returns") == std::vector<double>{5, 1});
    CHECK(values_of(cloud, "classification") == std::vector<double>{31, 0});
    CHECK(values_of(cloud, "withheld") == std::vector<double>{0, 0});
    CHECK(values_of(cloud, "scan_direction_flag") == std::vector<double>{1, 1});
    CHECK(values_of(cloud, "edge_of_flight_line") == std::vector<double>{0, 0});
    CHECK(values_of(cloud, "user_data") == std::vector<double>{200, 0});
    CHECK(values_of(cloud, "point_source_id") == std::vector<double>{40000, 0});
    CHECK(values_of(cloud, "scan_angle") == std::vector<double>{format <= 5 ? -90.0 : -90 * 0.006, 0});
    const bool has_time = format != 0 && format != 2;
    REQUIRE(has_field(cloud, "gps_time") == has_time);
    if (has_time) CHECK(values_of(cloud, "gps_time") == std::vector<double>{123456.789, -1.5});
    REQUIRE(has_field(cloud, "nir") == (format == 8 || format == 10));
    if (has_field(cloud, "nir")) CHECK(values_of(cloud, "nir") == std::vector<double>{999, 0});
    if (format > 5) CHECK(values_of(cloud, "scanner_channel") == std::vector<double>{2, 2});
    const bool has_colour =
        std::vector<bool>{false, false, true, true, false, true, false, true, true, false, true}[format];
    REQUIRE(!cloud.colour.empty() == has_colour);
    // Half a step of 16 bits, for the rounding of a float.
    if (has_colour)
      CHECK((cloud.colour[0] - Vector3f(1.0f, 32768 / 65535.0f, 257 / 65535.0f)).norm() < 0.5f / 65535.0f);
    CHECK(mentions(report.notes, "waveforms") == (format == 4 || format == 5 || format >= 9));
    CHECK(report.up == Vector3d::UnitZ());
    CHECK(report.warnings.empty());
  }
}

TEST_CASE("las read: colours of 8 bits in 16 and colours that are all zero") {
  LasFile file;
  file.format = 2;
  for (int i = 0; i < 2000; ++i) {
    file.points.emplace_back();
    file.points.back().position = {i, 2 * i, i % 7};
    file.points.back().colour = {static_cast<std::uint16_t>(i % 256), 255, 51};
  }
  file.points[3].colour = {65535, 65535, 65535}; // one that is not like the others decides nothing
  const PointCloud cloud = read(file).cloud;
  REQUIRE(cloud.colour.size() == 2000);
  CHECK((cloud.colour[100] - Vector3f(100 / 255.0f, 1.0f, 0.2f)).norm() < 1e-6f); // rounding of floats
  for (LasPoint& p : file.points)
    p.colour = {0, 0, 0};
  const auto [cloud_without, report] = read(file);
  CHECK(cloud_without.colour.empty());
  CHECK(mentions(report.notes, "the colours of all points are 0"));
  CHECK(has_field(cloud_without, "intensity")); // it stands in for them
}

TEST_CASE("las read: either count of points may be the one that is filled") {
  LasFile file = two_points(3);
  file.minor = 4;
  struct Counts {
    std::int64_t narrow, wide;
    bool warned;
  };
  for (const Counts& counts :
       {Counts{2, 0, false}, {0, 2, false}, {2, 2, false}, {7, 2, true}, {2, 7, true}, {1, 2, true}}) {
    INFO(counts.narrow << " and " << counts.wide);
    file.count = counts.narrow;
    file.wide_count = counts.wide;
    const auto [cloud, report] = read(file);
    CHECK(cloud.size() == 2);
    CHECK(report.points_in_file == 2);
    CHECK(mentions(report.warnings, "counts") == counts.warned);
  }
}

TEST_CASE("las read: extra bytes are fields with their scale and offset, described or not") {
  LasFile file = two_points(1);
  const std::string entries = las_extra_entry_bytes("Deviation", 4, 8 + 16, {0.5, 0, 0}, {100, 0, 0}) +
                              las_extra_entry_bytes("NormalX", 9) + las_extra_entry_bytes("NormalY", 9) +
                              las_extra_entry_bytes("NormalZ", 9) + las_extra_entry_bytes("", 0, 3) +
                              las_extra_entry_bytes("Colors", 23) + las_extra_entry_bytes("Count", 7, 8, {0, 0, 0});
  file.vlrs = {las_vlr("someone", 4, "not these"), las_vlr("LASF_Spec", 4, entries)};
  for (const std::int16_t value : std::array<std::int16_t, 2>{-3, 8})
    file.extra.push_back(bytes_of(value) + bytes_of(0.0f) + bytes_of(0.6f) + bytes_of(0.8f) + "\1\2\3" +
                         bytes_of<std::uint16_t>(10) + bytes_of<std::uint16_t>(20) + bytes_of<std::uint16_t>(30) +
                         bytes_of<std::uint64_t>(1ull << 40) + "\7");
  const auto [cloud, report] =
      read(file, {0.0, {"deviation", "Colors1", "extra_bytes2", "extra_bytes3", "Count"}, false});
  CHECK(values_of(cloud, "Deviation") == std::vector<double>{98.5, 104.0});
  CHECK(values_of(cloud, "Colors1") == std::vector<double>{20, 20});
  CHECK(values_of(cloud, "extra_bytes2") == std::vector<double>{3, 3});
  CHECK(values_of(cloud, "extra_bytes3") == std::vector<double>{7, 7}); // behind what is described
  CHECK(values_of(cloud, "Count") == std::vector<double>{1099511627776.0, 1099511627776.0});
  // What they are called is what they are: CloudCompare keeps normals here.
  REQUIRE(cloud.normal.size() == 2);
  CHECK(cloud.normal[0] == Vector3f(0.0f, 0.6f, 0.8f));
  CHECK(report.warnings.empty());

  // The same record behind the points, and entries that ask for more than there is.
  file.minor = 4;
  file.vlrs = {};
  file.evlrs = {las_vlr("LASF_Spec", 4, entries + las_extra_entry_bytes("Too much", 10), true)};
  const auto [late, late_report] = read(file, {0.0, {"Deviation"}, false});
  CHECK(values_of(late, "Deviation") == std::vector<double>{98.5, 104.0});
  CHECK(mentions(late_report.warnings, "\"Too much\""));
}

TEST_CASE("las read: points marked as withheld or as noise are kept and told") {
  for (const unsigned format : {1u, 6u}) {
    LasFile file = two_points(format);
    file.points[0].withheld = true;
    file.points[1].classification = format == 1 ? 7 : 18;
    const auto [cloud, report] = read(file);
    CHECK(cloud.size() == 2);
    CHECK(mentions(report.notes, "1 points are marked as withheld"));
    CHECK(mentions(report.notes, "1 points are classified as noise"));
  }
}

TEST_CASE("las read: degrees are placed in metres and positions stay what the file has") {
  LasFile file = in_degrees();
  const std::string wkt = "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]]]";
  const std::vector<std::pair<std::string, bool>> declarations{
      {geo_keys(1024, 2), true},
      {geo_keys(2048, 4326), true},
      {las_vlr("LASF_Projection", 2112, wkt), true},
      {"", true}, // by its shape: 0.009 degrees wide and a metre high
      {geo_keys(1024, 1), false},
      {las_vlr("LASF_Projection", 2112, "PROJCS[\"UTM\"," + wkt + "]"), false}};
  for (const auto& [vlr, expected] : declarations) {
    INFO(vlr.substr(std::min<std::size_t>(vlr.size(), 54)));
    file.vlrs = vlr.empty() ? std::vector<std::string>{} : std::vector<std::string>{vlr};
    if (vlr.empty())
      for (LasPoint& p : file.points)
        p.position[2] *= 20; // 20 m high
    const auto [cloud, report] = read(file);
    CHECK(cloud.position[0].head(2) == Eigen::Vector2d(100000000 * 1e-7, 450000000 * 1e-7));
    REQUIRE(report.placement.has_value() == expected);
    CHECK(mentions(report.notes, "longitude and latitude") == expected);
    if (!expected) continue;
    // WGS 84 at 45 degrees: 78847 and 111132 metres a degree.
    const Vector3d a = (*report.placement)(cloud.position[0]), b = (*report.placement)(cloud.position[99]);
    CHECK(b.x() - a.x() == Approx(0.009 * 78847).epsilon(1e-4));
    CHECK(b.y() - a.y() == Approx(0.009 * 111132).epsilon(1e-4));
    CHECK(b.z() - a.z() == Approx(cloud.position[99].z() - cloud.position[0].z()));
  }
  // Metres near zero are no degrees, however tall the thing is.
  file = in_degrees();
  file.scale = {1e-4, 1e-4, 0.01};
  for (std::size_t i = 0; i < file.points.size(); ++i)
    file.points[i].position = {static_cast<int>(i % 10), static_cast<int>(i / 10), static_cast<int>(i)};
  CHECK_FALSE(read(file).report.placement.has_value());
}

TEST_CASE("las read: coordinates from the Earth's centre have their own up") {
  LasFile file = two_points(0);
  file.offset = {4000000.0, 0.0, 5000000.0};
  file.scale = {0.01, 0.01, 0.01};
  for (LasPoint& p : file.points)
    p.position = {0, 0, 0};
  file.vlrs = {geo_keys(1024, 3)};
  const auto up = read(file).report.up;
  REQUIRE(up.has_value());
  CHECK((*up - Vector3d(4, 0, 5).normalized()).norm() < 1e-12);
}

TEST_CASE("las read: more than one piece of a file is read in its order") {
  LasFile file;
  for (int i = 0; i < 120000; ++i) { // 2.4 MB
    file.points.emplace_back();
    file.points.back().position = {i, -i, 3 * i};
  }
  const PointCloud cloud = read(file).cloud;
  REQUIRE(cloud.size() == 120000);
  bool in_order = true;
  for (int i = 0; i < 120000; ++i)
    in_order = in_order && cloud.position[static_cast<std::size_t>(i)] == Vector3d(i * 0.01, -i * 0.01, 3 * i * 0.01);
  CHECK(in_order);
}
