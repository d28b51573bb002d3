#pragma once
/// Point samplings of surfaces whose area and normals are known, for the tests of this folder.
#include "host/cloud/knn.h"
#include "host/cloud/point_cloud.h"
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

namespace pointgi::test {

constexpr double pi = 3.14159265358979323846;

inline void add(PointCloud& cloud, const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  cloud.position.push_back(position);
  cloud.normal.push_back(normal.cast<float>());
}

/// Unit sphere, points along a golden spiral: as even as points get.
inline PointCloud fibonacci_sphere(int n) {
  PointCloud cloud;
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n, ring = std::sqrt(1.0 - z * z);
    const double angle = i * pi * (3.0 - std::sqrt(5.0));
    const Eigen::Vector3d p(ring * std::cos(angle), ring * std::sin(angle), z);
    add(cloud, p, p);
  }
  return cloud;
}

/// One random point of a surface and its normal there.
struct SurfacePoint {
  Eigen::Vector3d position, normal;
};
using Sampler = std::function<SurfacePoint(std::mt19937_64&)>;

inline double uniform(std::mt19937_64& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

inline SurfacePoint on_sphere(std::mt19937_64& random) {
  const double z = uniform(random, -1, 1), angle = uniform(random, 0, 2 * pi), ring = std::sqrt(1 - z * z);
  const Eigen::Vector3d p(ring * std::cos(angle), ring * std::sin(angle), z);
  return {p, p};
}

/// Cube of edge 1 about the origin.
inline SurfacePoint on_cube(std::mt19937_64& random) {
  const auto face = static_cast<int>(random() % 6);
  Eigen::Vector3d p(uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5));
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[face / 2] = face % 2 == 0 ? 1 : -1;
  p[face / 2] = 0.5 * normal[face / 2];
  return {p, normal};
}

constexpr double torus_large = 1.0, torus_small = 0.4;
constexpr double torus_area = 4 * pi * pi * torus_large * torus_small;

inline SurfacePoint torus_at(double around, double tube) {
  const Eigen::Vector3d out(std::cos(around), std::sin(around), 0);
  const Eigen::Vector3d normal = std::cos(tube) * out + std::sin(tube) * Eigen::Vector3d::UnitZ();
  return {torus_large * out + torus_small * normal, normal};
}

inline SurfacePoint on_torus(std::mt19937_64& random) {
  for (;;) { // the outer half has more area
    const double tube = uniform(random, 0, 2 * pi);
    const double share = (torus_large + torus_small * std::cos(tube)) / (torus_large + torus_small);
    if (uniform(random, 0, 1) < share) return torus_at(uniform(random, 0, 2 * pi), tube);
  }
}

inline PointCloud random_sampling(const Sampler& sampler, int n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  PointCloud cloud;
  for (int i = 0; i < n; ++i) {
    const SurfacePoint p = sampler(random);
    add(cloud, p.position, p.normal);
  }
  return cloud;
}

/// Rings of a torus, `around` of them with `tube` points each.
inline PointCloud regular_torus(int around, int tube) {
  PointCloud cloud;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < tube; ++j) {
      const SurfacePoint p = torus_at(2 * pi * i / around, 2 * pi * j / tube);
      add(cloud, p.position, p.normal);
    }
  return cloud;
}

/// The six faces of the cube, n x n points each: at the centres of cells, or (`edges`) from edge to edge, so that two
/// or three points with different normals coincide on the cube's edges.
inline PointCloud grid_cube(int n, bool edges) {
  PointCloud cloud;
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int k) { return (edges ? static_cast<double>(k) / (n - 1) : (k + 0.5) / n) - 0.5; };
        Eigen::Vector3d p, normal = Eigen::Vector3d::Zero();
        normal[face / 2] = face % 2 == 0 ? 1 : -1;
        p[face / 2] = 0.5 * normal[face / 2];
        p[(face / 2 + 1) % 3] = at(i);
        p[(face / 2 + 2) % 3] = at(j);
        add(cloud, p, normal);
      }
  return cloud;
}

inline double total(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values)
    sum += static_cast<double>(value);
  return sum;
}

/// Mean of r_i over the radius of a disc with area A_i: 1 would be discs that do not overlap at all; squares under
/// discs that just cover them have 1.25, hexagons 1.10.
inline double mean_waste(const PointCloud& cloud) {
  double sum = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    sum += static_cast<double>(cloud.radius[i]) / std::sqrt(static_cast<double>(cloud.area[i]) / pi);
  return sum / static_cast<double>(cloud.size());
}

/// Share of `tries` random points of the surface that lie within no splat: in a splat's plane nearer than its radius,
/// and not further above or below it than that.
inline double uncovered_share(const PointCloud& cloud, const Sampler& sampler, int tries, std::uint64_t seed) {
  const Sites sites(cloud.position);
  std::mt19937_64 random(seed);
  std::vector<Neighbour> near(256);
  int uncovered = 0;
  for (int t = 0; t < tries; ++t) {
    const Eigen::Vector3d p = sampler(random).position;
    bool covered = false;
    for (const unsigned k : {8u, 256u}) { // the nearest few nearly always do
      const unsigned count = sites.nearest_to(sites.to_local(p), k, near.data());
      for (unsigned j = 0; j < count && !covered; ++j)
        for (const std::uint32_t i : sites.points(near[j].site)) {
          const Eigen::Vector3d e = p - cloud.position[i], normal = cloud.normal[i].cast<double>();
          const double height = e.dot(normal), radius = static_cast<double>(cloud.radius[i]);
          covered = covered || (std::abs(height) <= radius && e.squaredNorm() - height * height <= radius * radius);
        }
      if (covered) break;
    }
    uncovered += covered ? 0 : 1;
  }
  return static_cast<double>(uncovered) / tries;
}

} // namespace pointgi::test
