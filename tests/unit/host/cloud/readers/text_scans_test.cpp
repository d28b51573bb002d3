/// Text, grids and Gaussians that scanners, phones and trainers wrote, against what other programs read from them
/// (truth.json beside the files).
#include "host/cloud/readers/readers.h"
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;

namespace {

Vector3d vector_of(const nlohmann::json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

Vector3d mean_of(const std::vector<Eigen::Vector3f>& colours) {
  Vector3d sum = Vector3d::Zero();
  for (const Eigen::Vector3f& colour : colours)
    sum += 255.0 * colour.cast<double>();
  return sum / static_cast<double>(colours.size());
}

void compare(const PointCloud& cloud, const nlohmann::json& truth) {
  CHECK(cloud.size() == truth.at("points").get<std::size_t>());
  Vector3d low = cloud.position.at(0), high = low;
  for (const Vector3d& position : cloud.position) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  // Other programs turn points into the world in another order of operations.
  const double step = 1e-6 * std::max(low.lpNorm<Eigen::Infinity>(), high.lpNorm<Eigen::Infinity>());
  CHECK((low - vector_of(truth.at("min"))).lpNorm<Eigen::Infinity>() <= step);
  CHECK((high - vector_of(truth.at("max"))).lpNorm<Eigen::Infinity>() <= step);
  if (truth.at("mean_colour").is_null())
    CHECK(cloud.colour.empty());
  else // the truth has three decimals; Gaussians' harmonics are floats there
    CHECK((mean_of(cloud.colour) - vector_of(truth.at("mean_colour"))).lpNorm<Eigen::Infinity>() <= 0.002);
  REQUIRE(cloud.stations.size() == truth.at("stations").size());
  for (std::size_t i = 0; i < cloud.stations.size(); ++i)
    CHECK((cloud.stations[i] - vector_of(truth.at("stations")[i])).norm() <= step);
  if (!truth.contains("mean_opacity")) return;
  double opacity = 0.0;
  for (const float value : cloud.opacity)
    opacity += static_cast<double>(value) / static_cast<double>(cloud.size());
  CHECK(opacity == Approx(truth.at("mean_opacity").get<double>()).margin(1e-5)); // five decimals
}

} // namespace

TEST_CASE("text scans: points, bounds, colours and stations are what other programs read") {
  const auto truth_path = scan_path("real/truth.json");
  if (!truth_path) {
    WARN("skipped: no folder real among the scans");
    return;
  }
  const std::filesystem::path folder = std::filesystem::path(*truth_path).parent_path();
  const nlohmann::json truth = nlohmann::json::parse(contents(*truth_path));
  std::size_t compared = 0;
  for (const auto& [name, expected] : truth.items()) {
    const std::string extension = std::filesystem::path(name).extension().string();
    const bool text =
        extension == ".xyz" || extension == ".ptx" || extension == ".pts" || extension == ".csv" || extension == ".txt";
    if (!text && !expected.contains("mean_opacity")) continue;
    INFO(name);
    CloudReport report;
    compare(read_cloud((folder / name).string(), {}, report), expected);
    ++compared;
  }
  CHECK(compared >= 12);
}
