#pragma once
/// Things that stand, for the tests of views: made of simple shapes, complete clouds.
#include "host/scene/sample_shape.h"
#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace pointgi::test {

inline void add(PointCloud& to, const PointCloud& part) {
  const auto join = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
  join(to.position, part.position);
  join(to.normal, part.normal);
  join(to.radius, part.radius);
  join(to.area, part.area);
}

inline PointCloud shape(const ShapeGeometry& geometry, double spacing) {
  ShapeSettings settings;
  settings.geometry = geometry;
  settings.spacing = spacing;
  return sample_shape(settings);
}

inline PointCloud box(const Vector3d& low, const Vector3d& high, bool inward = false) {
  return shape(BoxShape{low, high, inward}, 0.04);
}

/// Radii at equal steps of height from 0 to 1, turned about y; `count` points at random, even in area.
template <typename Radius>
PointCloud turned(const Radius& radius, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  PointCloud cloud;
  constexpr double step = 1e-3, most = 1.2;
  while (cloud.size() < count) {
    const double y = u(random), r = radius(y), slope = (radius(y + step) - radius(y - step)) / (2.0 * step);
    if (u(random) * most > r * std::min(4.0, std::sqrt(1.0 + slope * slope))) continue;
    const double turn = 6.283185307179586 * u(random);
    cloud.position.emplace_back(r * std::cos(turn), y, r * std::sin(turn));
    cloud.normal.push_back(Vector3d(std::cos(turn), -slope, std::sin(turn)).normalized().cast<float>());
  }
  cloud.radius.assign(count, 0.03f);
  cloud.area.assign(count, static_cast<float>(3.0 / static_cast<double>(count)));
  return cloud;
}

/// A foot, a stem and a bowl that is wider than the foot.
inline PointCloud goblet() {
  PointCloud cloud = turned(
      [](double y) {
        if (y < 0.03) return 0.22;
        if (y < 0.45) return 0.04;
        return 0.04 + 0.31 * std::sqrt(std::min(1.0, (y - 0.45) / 0.5));
      },
      6000, 1);
  add(cloud, shape(DiscShape{Vector3d(0, 0, 0), Vector3d(0, -1, 0), 0.22}, 0.02));
  return cloud;
}

/// A trunk and a crown.
inline PointCloud tree() {
  PointCloud cloud = shape(CylinderShape{Vector3d(0, 0, 0), Vector3d(0, 0.5, 0), 0.04, false}, 0.02);
  add(cloud, shape(SphereShape{Vector3d(0, 0.75, 0), 0.3, false}, 0.02));
  return cloud;
}

inline PointCloud vase() {
  PointCloud cloud = turned([](double y) { return 0.2 + 0.15 * std::sin(5.0 * y); }, 6000, 2);
  add(cloud, shape(DiscShape{Vector3d(0, 0, 0), Vector3d(0, -1, 0), 0.2}, 0.02));
  return cloud;
}

/// Narrow above, on a broad flat slab.
inline PointCloud statue() {
  PointCloud cloud = box({-0.4, 0.0, -0.3}, {0.4, 0.1, 0.3});
  add(cloud, shape(CylinderShape{Vector3d(0, 0.1, 0), Vector3d(0.05, 0.8, 0), 0.12, false}, 0.02));
  add(cloud, shape(SphereShape{Vector3d(0.05, 0.88, 0.02), 0.1, false}, 0.02));
  return cloud;
}

/// Legs, a seat and a back at -z.
inline PointCloud chair() {
  PointCloud cloud = box({-0.25, 0.42, -0.25}, {0.25, 0.47, 0.25});
  add(cloud, box({-0.25, 0.47, -0.25}, {0.25, 1.0, -0.21}));
  for (const double x : {-0.25, 0.21})
    for (const double z : {-0.25, 0.21})
      add(cloud, shape(BoxShape{{x, 0.0, z}, {x + 0.04, 0.42, z + 0.04}, false}, 0.02));
  return cloud;
}

/// y -> z, z -> -y: what stood along y stands along z.
inline PointCloud z_up(PointCloud cloud) {
  const auto turn = [](auto& v) { v = {v.x(), -v.z(), v.y()}; };
  for (auto& p : cloud.position)
    turn(p);
  for (auto& n : cloud.normal)
    turn(n);
  return cloud;
}

/// Half a turn about x.
inline PointCloud upside_down(PointCloud cloud) {
  const auto turn = [](auto& v) { v = {v.x(), -v.y(), -v.z()}; };
  for (auto& p : cloud.position)
    turn(p);
  for (auto& n : cloud.normal)
    turn(n);
  return cloud;
}

} // namespace pointgi::test
