/// Writes scenes/demo/statue.ply: a procedural bust on a fluted column, as a scan of it might come out: points with
/// normals and colours, unevenly spaced, no triangles.
///   make_statue OUT.ply [POINTS]
#include "host/cloud/readers/ply.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <unordered_map>

namespace {

using Eigen::Vector3d;

double smooth_union(double a, double b, double k) {
  const double h = std::clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
  return b + (a - b) * h - k * h * (1.0 - h);
}

double smooth_cut(double body, double tool, double k) {
  return -smooth_union(-body, tool, k);
}

double ellipsoid(const Vector3d& p, const Vector3d& radii) {
  const double k0 = p.cwiseQuotient(radii).norm(), k1 = p.cwiseQuotient(radii.cwiseProduct(radii)).norm();
  return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -radii.minCoeff();
}

double capsule(const Vector3d& p, const Vector3d& a, const Vector3d& b, double r) {
  const Vector3d pa = p - a, ba = b - a;
  const double h = std::clamp(pa.dot(ba) / ba.squaredNorm(), 0.0, 1.0);
  return (pa - h * ba).norm() - r;
}

double rounded_box(const Vector3d& p, const Vector3d& half, double r) {
  const Vector3d q = p.cwiseAbs() - half + Vector3d::Constant(r);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - r;
}

double drum(const Vector3d& p, double radius, double half_height, double r) {
  const double d = std::hypot(p.x(), p.z()) - radius + r, h = std::fabs(p.y()) - half_height + r;
  return std::hypot(std::max(d, 0.0), std::max(h, 0.0)) + std::min(std::max(d, h), 0.0) - r;
}

double pedestal(const Vector3d& p) {
  double d = rounded_box(p - Vector3d(0, 0.04, 0), {0.24, 0.04, 0.24}, 0.012);
  d = std::min(d, drum(p - Vector3d(0, 0.105, 0), 0.205, 0.03, 0.028));
  const double flutes = 0.006 * (std::fabs(std::sin(9.0 * std::atan2(p.z(), p.x()))) - 0.5);
  d = std::min(d, drum(p - Vector3d(0, 0.29, 0), 0.165, 0.17, 0.01) - flutes);
  d = std::min(d, drum(p - Vector3d(0, 0.455, 0), 0.19, 0.022, 0.02));
  return std::min(d, rounded_box(p - Vector3d(0, 0.495, 0), {0.205, 0.022, 0.205}, 0.008));
}

double head(const Vector3d& q) { // about the middle of the skull, +z is the face
  double d = ellipsoid(q, {0.082, 0.105, 0.095});
  d = smooth_union(d, ellipsoid(q - Vector3d(0, -0.075, 0.022), {0.052, 0.048, 0.06}), 0.035); // jaw
  for (const double side : {-1.0, 1.0}) {
    d = smooth_cut(d, ellipsoid(q - Vector3d(side * 0.034, 0.006, 0.094), {0.02, 0.013, 0.016}), 0.012); // eye sockets
    d = smooth_union(d, ellipsoid(q - Vector3d(side * 0.033, 0.004, 0.079), {0.013, 0.009, 0.01}), 0.004);
    d = smooth_union(d, ellipsoid(q - Vector3d(side * 0.085, -0.012, -0.002), {0.01, 0.026, 0.018}), 0.008); // ears
  }
  d = smooth_union(d, capsule(q, {0, 0.018, 0.092}, {0, -0.03, 0.112}, 0.010), 0.014);          // nose
  d = smooth_union(d, ellipsoid(q - Vector3d(0, -0.062, 0.086), {0.022, 0.007, 0.012}), 0.008); // lips
  const double curls = 0.007 * std::sin(75.0 * q.x()) * std::sin(70.0 * q.y() + 2.0) * std::sin(75.0 * q.z());
  const double hair = ellipsoid(q - Vector3d(0, 0.028, -0.018), {0.094, 0.098, 0.098}) + curls;
  const double forehead = ellipsoid(q - Vector3d(0, -0.03, 0.105), {0.085, 0.105, 0.075});
  return smooth_union(d, smooth_cut(hair, forehead, 0.015), 0.01);
}

double bust(const Vector3d& p) {
  const double angle = std::atan2(p.z(), p.x()), y = p.y();
  double d = ellipsoid(p - Vector3d(0, 0.66, 0), {0.15, 0.17, 0.105});                         // chest
  d = smooth_union(d, ellipsoid(p - Vector3d(0, 0.765, -0.005), {0.205, 0.062, 0.088}), 0.07); // shoulders
  const double folds = 0.006 * std::sin(11.0 * angle + 30.0 * y) + 0.003 * std::sin(23.0 * angle - 31.0 * y);
  d = smooth_union(d, ellipsoid(p - Vector3d(0, 0.61, 0.005), {0.172, 0.125, 0.125}) + folds, 0.025);   // robe
  d = smooth_union(d, capsule(p, {-0.18, 0.77, 0.02}, {0.13, 0.58, 0.115}, 0.026) + 0.6 * folds, 0.03); // its sash
  d = smooth_union(d, capsule(p, {0, 0.78, -0.01}, {0, 0.89, 0.005}, 0.05), 0.035);                     // neck
  // The head is turned a little to the right and bowed.
  Vector3d q = p - Vector3d(0, 0.965, 0.012);
  const double c = std::cos(0.42), s = std::sin(0.42);
  q = Vector3d(c * q.x() - s * q.z(), q.y(), s * q.x() + c * q.z());
  const double cb = std::cos(0.1), sb = std::sin(0.1);
  q = Vector3d(q.x(), cb * q.y() + sb * q.z(), -sb * q.y() + cb * q.z());
  d = smooth_union(d, head(q), 0.02);
  return std::max(d, 0.505 - y); // cut where it stands on the column
}

double statue(const Vector3d& p) {
  return std::min(pedestal(p), bust(p));
}

Vector3d gradient(const Vector3d& p) {
  constexpr double h = 2e-4;
  Vector3d g;
  for (int a = 0; a < 3; ++a)
    g[a] = statue(p + h * Vector3d::Unit(a)) - statue(p - h * Vector3d::Unit(a));
  return g.normalized();
}

/// Weathered limestone, darker in hollows: how far the surface curves in decides.
Eigen::Vector3f colour(const Vector3d& p, const Vector3d& n) {
  const double hollow = std::clamp((0.03 - statue(p + 0.03 * n)) / 0.02, 0.0, 1.0);
  const double veins = 0.5 + 0.5 * std::sin(9.0 * p.x() + 4.0 * std::sin(7.0 * p.y()) + 5.0 * std::sin(6.0 * p.z()));
  const double light = 1.0 - 0.45 * hollow - 0.10 * veins;
  return Eigen::Vector3f(0.93f, 0.89f, 0.81f) * static_cast<float>(light);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: make_statue OUT.ply [POINTS]\n");
    return 2;
  }
  const long wanted = argc > 2 ? std::atol(argv[2]) : 36000;
  // Surface of about 1.2 square units; candidates nearer to a kept point than this are dropped.
  const double nearest = 0.78 * std::sqrt(1.2 / static_cast<double>(wanted));
  std::mt19937 g(20091);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::unordered_map<long, std::vector<std::size_t>> grid;
  const auto cell = [&](const Vector3d& p, int dx, int dy, int dz) {
    const auto at = [&](double v, int d) { return static_cast<long>(std::floor(v / nearest)) + d + 4096; };
    return (at(p.x(), dx) * 16384 + at(p.y(), dy)) * 16384 + at(p.z(), dz);
  };
  pointgi::PointCloud cloud;
  for (long tries = 0; tries < 40 * wanted; ++tries) {
    Vector3d p(-0.27 + 0.54 * unit(g), -0.01 + 1.12 * unit(g), -0.27 + 0.54 * unit(g));
    for (int i = 0; i < 12; ++i)
      p -= 0.9 * statue(p) * gradient(p);
    if (std::fabs(statue(p)) > 1e-4 || p.y() < 0.002) continue;
    bool free = true;
    for (int k = 0; k < 27 && free; ++k)
      for (const std::size_t other : grid[cell(p, k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)])
        free = free && (cloud.position[other] - p).norm() > nearest;
    if (!free) continue;
    grid[cell(p, 0, 0, 0)].push_back(cloud.size());
    const Vector3d n = gradient(p);
    cloud.position.push_back(p);
    cloud.normal.push_back(n.cast<float>());
    cloud.colour.push_back(colour(p, n));
  }
  pointgi::write_ply(argv[1], cloud);
  std::printf("%zu points\n", cloud.size());
}
