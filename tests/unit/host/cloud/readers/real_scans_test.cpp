/// Files that scanners, phones and converters wrote, against what other programs read from them (truth.json beside
/// the files).
#include "host/cloud/readers/readers.h"
#include "host/error.h"
#include "tests/support/imported.h"
#include "tests/support/scans.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Measured {
  std::size_t finite = 0, with_normal = 0;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL), high = -low, colour = Eigen::Vector3d::Zero();
};

Measured measure(const PointCloud& cloud) {
  Measured result;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.position[i].allFinite()) continue;
    result.finite += 1;
    result.low = result.low.cwiseMin(cloud.position[i]);
    result.high = result.high.cwiseMax(cloud.position[i]);
    if (!cloud.normal.empty() && cloud.normal[i].allFinite() && cloud.normal[i].squaredNorm() > 0.0f)
      result.with_normal += 1;
    if (!cloud.colour.empty()) result.colour += 255.0 * cloud.colour[i].cast<double>();
  }
  if (result.finite > 0) result.colour /= static_cast<double>(result.finite);
  return result;
}

Eigen::Vector3d vector_of(const nlohmann::json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

/// Those of E57 and PTX, and the position of PCD's VIEWPOINT where that was set.
std::vector<Eigen::Vector3d> stations_of(const nlohmann::json& truth) {
  std::vector<Eigen::Vector3d> stations;
  for (const nlohmann::json& station : truth.at("stations"))
    stations.push_back(vector_of(station));
  if (truth.contains("viewpoint") && !vector_of(truth["viewpoint"]).isZero())
    stations.push_back(vector_of(truth["viewpoint"]));
  return stations;
}

bool has_normals_in_truth(const std::string& path, const nlohmann::json& truth) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return (extension == ".ply" || extension == ".pcd") && !truth.contains("mean_opacity");
}

void compare(const std::string& path, const PointCloud& cloud, const CloudReport& report, const nlohmann::json& truth) {
  const Measured measured = measure(cloud);
  CHECK(report.points_in_file == truth.at("points").get<std::size_t>());
  CHECK(measured.finite == truth.at("finite").get<std::size_t>());
  // Of the largest coordinate: other programs turn points into the world in another order of operations.
  const Eigen::Vector3d low = vector_of(truth.at("min")), high = vector_of(truth.at("max"));
  const double step = 1e-6 * std::max(low.lpNorm<Eigen::Infinity>(), high.lpNorm<Eigen::Infinity>());
  CHECK((measured.low - low).lpNorm<Eigen::Infinity>() <= step);
  CHECK((measured.high - high).lpNorm<Eigen::Infinity>() <= step);
  if (truth.at("mean_colour").is_null())
    CHECK(cloud.colour.empty());
  else // the truth has three decimals
    CHECK((measured.colour - vector_of(truth.at("mean_colour"))).lpNorm<Eigen::Infinity>() <= 1e-3);
  // The truth counts normals of PLY and PCD alone; those of Gaussians are not in the file, but in their shapes.
  if (has_normals_in_truth(path, truth))
    CHECK(static_cast<double>(measured.with_normal) / static_cast<double>(cloud.size()) ==
          Approx(truth.at("share_with_normals").get<double>()).margin(1e-6));
  if (truth.contains("mean_opacity")) { // with five decimals
    double opacity = 0.0;
    for (const float value : cloud.opacity)
      opacity += static_cast<double>(value) / static_cast<double>(cloud.size());
    CHECK(opacity == Approx(truth.at("mean_opacity").get<double>()).margin(1e-5));
  }
  const std::vector<Eigen::Vector3d> stations = stations_of(truth);
  CHECK(cloud.stations.size() == stations.size());
  for (std::size_t i = 0; i < std::min(cloud.stations.size(), stations.size()); ++i)
    CHECK((cloud.stations[i] - stations[i]).norm() <= step);
  if (!truth.contains("points_per_station")) return;
  std::vector<std::size_t> counts(cloud.stations.size(), 0);
  for (const std::uint16_t station : cloud.station)
    if (station < counts.size()) counts[station] += 1;
  if (cloud.station.empty() && counts.size() == 1) counts[0] = cloud.size(); // the only one needs no index
  CHECK(counts == truth.at("points_per_station").get<std::vector<std::size_t>>());
}

/// Calls check(path, truth) for each of the files that lie there.
template <class Check>
void for_each_real_scan(const Check& check) {
  const auto truth_path = scan_path("real/truth.json");
  if (!truth_path) {
    WARN("skipped: no folder real among the scans");
    return;
  }
  const std::filesystem::path folder = std::filesystem::path(*truth_path).parent_path();
  const nlohmann::json truth = nlohmann::json::parse(contents(*truth_path));
  for (const auto& [name, expected] : truth.items()) {
    INFO(name);
    check((folder / name).string(), expected);
  }
}

} // namespace

TEST_CASE("real scans: points, bounds, colours, normals and stations are what other programs read") {
  for_each_real_scan([](const std::string& path, const nlohmann::json& truth) {
    CloudReport report;
    PointCloud cloud;
    REQUIRE_NOTHROW(cloud = read_cloud(path, {}, report));
    compare(path, cloud, report, truth);
  });
}

TEST_CASE("real scans: scripts/import keeps the same") {
  if (!import_is_installed()) {
    WARN("skipped: scripts/import has not been run before");
    something_skipped = true;
    return;
  }
  for_each_real_scan([](const std::string& path, const nlohmann::json& truth) {
    if (path.find(".laz") == std::string::npos && path.find(".e57") == std::string::npos) return;
    const TemporaryFolder folder;
    const ImportRun run = run_import(path, folder);
    INFO(run.err);
    REQUIRE(run.code == 0);
    CloudReport report;
    compare(path, read_cloud(run.ply, {}, report), report, truth);
    CHECK(report.up == Eigen::Vector3d(0, 0, 1));
  });
}
