#include "host/cloud/readers/las_read.h"
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

} // namespace

TEST_CASE("las read: real scans have the points, bounds and colours that laspy reads") {
  const auto truth_path = test::scan_path("real/truth.json");
  if (!truth_path) {
    WARN("skipped: no folder real among the scans");
    return;
  }
  const nlohmann::json truths = nlohmann::json::parse(test::contents(*truth_path));
  for (const auto& [name, truth] : truths.items()) {
    if (std::filesystem::path(name).extension() != ".las") continue;
    INFO(name);
    const auto path = test::scan_path("real/" + name);
    REQUIRE(path.has_value());
    CloudReport report;
    const PointCloud cloud = read_las(*path, {}, report);
    CHECK(cloud.size() == truth.at("points").get<std::size_t>());
    Vector3d low = cloud.position[0], high = low, colour = Vector3d::Zero();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      low = low.cwiseMin(cloud.position[i]);
      high = high.cwiseMax(cloud.position[i]);
      if (!cloud.colour.empty()) colour += 255.0 * cloud.colour[i].cast<double>() / static_cast<double>(cloud.size());
    }
    CHECK(low == vector_of(truth.at("min"))); // the same product and sum of doubles
    CHECK(high == vector_of(truth.at("max")));
    CHECK(cloud.colour.empty() == truth.at("mean_colour").is_null());
    if (!cloud.colour.empty()) // the truth has three decimals
      CHECK((colour - vector_of(truth.at("mean_colour"))).cwiseAbs().maxCoeff() <= 1e-3);
    CHECK(report.warnings.empty());
    CHECK(report.placement.has_value() == (name == "PDAL__epsg_4326.las"));
  }
}

TEST_CASE("las read: samples of other projects") {
  const std::vector<std::pair<std::string, std::size_t>> samples{{"simple.las", 1065}, {"autzen_trim.las", 110000}};
  for (const auto& [name, points] : samples) {
    const auto path = test::scan_path("formats/" + name);
    if (!path) {
      WARN("skipped: no scan " << name);
      continue;
    }
    CloudReport report;
    const PointCloud cloud = read_las(*path, {}, report);
    CHECK(cloud.size() == points);
    CHECK(cloud.colour.size() == points);
    CHECK(report.warnings.empty());
  }
  const auto none = test::scan_path("formats/no-points.las");
  if (!none) return;
  CloudReport report;
  CHECK_THROWS_WITH(read_las(*none, {}, report), Catch::Matchers::Contains("the header counts 0 points"));
}
