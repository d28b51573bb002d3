#include "host/cloud/readers/pcd_read.h"
#include "host/error.h"
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pointgi;
using Eigen::Vector3d;

namespace {

Vector3d vector_of(const nlohmann::json& three) {
  return {three.at(0).get<double>(), three.at(1).get<double>(), three.at(2).get<double>()};
}

/// Bounds and mean colour (0..255) of the points that are finite.
struct Measured {
  std::size_t finite = 0;
  Vector3d low = Vector3d::Constant(1e300), high = Vector3d::Constant(-1e300), colour = Vector3d::Zero();
};

Measured measure(const PointCloud& cloud) {
  Measured m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.position[i].allFinite()) continue;
    ++m.finite;
    m.low = m.low.cwiseMin(cloud.position[i]);
    m.high = m.high.cwiseMax(cloud.position[i]);
    if (!cloud.colour.empty()) m.colour += 255.0 * cloud.colour[i].cast<double>();
  }
  m.colour /= static_cast<double>(m.finite);
  return m;
}

} // namespace

TEST_CASE("pcd read: real scans have the points, bounds, colours and normals that other programs read") {
  const auto truth_path = test::scan_path("real/truth.json");
  if (!truth_path) {
    WARN("skipped: no folder real among the scans");
    return;
  }
  const nlohmann::json truths = nlohmann::json::parse(test::contents(*truth_path));
  for (const auto& [name, truth] : truths.items()) {
    if (std::filesystem::path(name).extension() != ".pcd") continue;
    INFO(name);
    const auto path = test::scan_path("real/" + name);
    REQUIRE(path.has_value());
    CloudReport report;
    const PointCloud cloud = read_pcd(*path, {}, report);
    CHECK(report.points_in_file == truth.at("points").get<std::size_t>());
    const Measured m = measure(cloud);
    CHECK(m.finite == truth.at("finite").get<std::size_t>());
    // Others parse text as floats, which the truth shows; binary values are the same.
    const bool is_text = report.format.find("ascii") != std::string::npos;
    const double step = is_text ? 1e-7 * vector_of(truth.at("max")).cwiseAbs().maxCoeff() : 0.0;
    CHECK((m.low - vector_of(truth.at("min"))).cwiseAbs().maxCoeff() <= step);
    CHECK((m.high - vector_of(truth.at("max"))).cwiseAbs().maxCoeff() <= step);
    CHECK(cloud.colour.empty() == truth.at("mean_colour").is_null());
    if (!cloud.colour.empty()) // the truth has three decimals
      CHECK((m.colour - vector_of(truth.at("mean_colour"))).cwiseAbs().maxCoeff() <= 1e-3);
    const auto normals = std::count_if(cloud.normal.begin(), cloud.normal.end(),
                                       [](const Eigen::Vector3f& n) { return n.squaredNorm() > 0.0f; });
    CHECK(static_cast<double>(normals) / static_cast<double>(cloud.size()) ==
          Approx(truth.at("share_with_normals").get<double>()).margin(1e-6)); // six decimals
    const bool has_place = truth.contains("viewpoint") && !vector_of(truth.at("viewpoint")).isZero();
    REQUIRE(cloud.stations.size() == (has_place ? 1u : 0u));
    if (has_place) CHECK(cloud.stations[0] == vector_of(truth.at("viewpoint")));
    CHECK(report.warnings.empty());
  }
}

TEST_CASE("pcd read: samples of other projects") {
  if (const auto path = test::scan_path("formats/region_growing_rgb_tutorial.pcd")) {
    CloudReport report;
    const PointCloud cloud = read_pcd(*path, {}, report);
    CHECK(cloud.size() == 307200);
    CHECK(measure(cloud).finite < 307200);
    CHECK(cloud.colour.size() == 307200);
  } else {
    WARN("skipped: no folder formats among the scans");
  }
  const auto headless = test::scan_path("formats/missingheader.pcd");
  if (!headless) return;
  CloudReport report;
  CHECK_THROWS_WITH(read_pcd(*headless, {}, report),
                    Catch::Matchers::Contains("line 1: ") && Catch::Matchers::Contains("the file has no PCD header"));
}
