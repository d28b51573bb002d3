#pragma once
/// What the tests of complete_cloud() ask of its results.
#include "host/cloud/complete.h"
#include <Eigen/Core>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace pointgi::test {

inline CloudReport complete(PointCloud& cloud, const CompleteOptions& options = {}) {
  CloudReport report;
  complete_cloud(cloud, options, report);
  return report;
}

/// What complete_cloud() promises of every cloud.
inline void check_promises(const PointCloud& cloud) {
  REQUIRE(cloud.normal.size() == cloud.size());
  REQUIRE(cloud.radius.size() == cloud.size());
  REQUIRE(cloud.area.size() == cloud.size());
  std::size_t bad = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    bad += !(std::abs(cloud.normal[i].norm() - 1) < 1e-5f); // float rounding
    bad += !(cloud.radius[i] > 0 && std::isfinite(cloud.radius[i]));
    bad += !(cloud.area[i] > 0 && std::isfinite(cloud.area[i]));
  }
  CHECK(bad == 0);
}

/// Share of points whose normal is on the same side as `truth`'s.
inline double agreement(const PointCloud& cloud, const std::vector<Eigen::Vector3f>& truth) {
  std::size_t agree = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    agree += cloud.normal[i].dot(truth[i]) > 0;
  return static_cast<double>(agree) / static_cast<double>(cloud.size());
}

inline bool warns_of(const CloudReport& report, const std::string& word) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& text) { return text.find(word) != std::string::npos; });
}

inline double mesh_volume(const PointCloud& cloud) {
  double volume = 0;
  for (const auto& t : cloud.triangle)
    volume += cloud.position[t[0]].dot(cloud.position[t[1]].cross(cloud.position[t[2]])) / 6;
  return volume;
}

} // namespace pointgi::test
