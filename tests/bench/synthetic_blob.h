#pragma once
/// The benchmark's scene: a bumpy ball over a floor, evenly sampled, as many splats as asked for.
#include "host/cloud/point_cloud.h"
#include <Eigen/Geometry>
#include <cmath>

namespace pointgi::bench {

inline double blob_radius(const Eigen::Vector3d& d) {
  return 1.0 + 0.11 * std::sin(6.0 * d.x()) * std::sin(7.0 * d.y()) * std::sin(5.0 * d.z()) +
         0.025 * std::sin(29.0 * d.x() + 1.0) * std::sin(31.0 * d.y()) * std::sin(27.0 * d.z());
}

inline PointCloud synthetic_blob(std::size_t splats) {
  const std::size_t ball = splats * 7 / 10;
  PointCloud cloud;
  const double golden = 3.14159265358979 * (3.0 - std::sqrt(5.0));
  const auto at = [](const Eigen::Vector3d& v) {
    return Eigen::Vector3d(v.normalized() * blob_radius(v.normalized()));
  };
  // Neighbours on a Fibonacci sphere lie up to 2.7 / sqrt(n) radii apart; bumps stretch that by up to a half.
  const auto ball_radius = static_cast<float>(4.1 / std::sqrt(static_cast<double>(ball)));
  for (std::size_t i = 0; i < ball; ++i) {
    const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(ball), s = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d d(s * std::cos(golden * static_cast<double>(i)),
                            s * std::sin(golden * static_cast<double>(i)), z);
    const Eigen::Vector3d u = d.unitOrthogonal() * 1e-4, v = d.cross(u);
    cloud.position.push_back(at(d));
    cloud.normal.push_back((at(d + u) - at(d - u)).cross(at(d + v) - at(d - v)).normalized().cast<float>());
    cloud.radius.push_back(ball_radius);
  }
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(splats - ball)));
  for (std::size_t i = 0; i < side * side; ++i) {
    const double step = 6.0 / static_cast<double>(side);
    cloud.position.emplace_back(-3.0 + step * (static_cast<double>(i % side) + 0.5),
                                -3.0 + step * (static_cast<double>(i / side) + 0.5), -1.2);
    cloud.normal.emplace_back(0.0f, 0.0f, 1.0f);
    cloud.radius.push_back(static_cast<float>(0.9 * step));
  }
  cloud.colour.assign(cloud.size(), Eigen::Vector3f::Constant(0.7f));
  cloud.area.assign(cloud.size(), 0.0f);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.area[i] = cloud.radius[i] * cloud.radius[i];
  return cloud;
}

} // namespace pointgi::bench
