#include "octree/vmap/facing.h"
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

/// A cosine below this is none: with it a wall whose normals are rounded would light itself by no more than 1e-5.
constexpr double flat_cosine = 1e-5;
/// Rounding of the positions and of their products with the axis: a few 6e-8 of coordinates below 1.
constexpr double rounding = 2e-7;

Vector vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

} // namespace

Facing facing(const Cluster& a, const Cluster& b) {
  if (static_cast<double>(a.cone) >= 0.5 * pi) return Facing::some;
  const Vector axis = vector_of(a.axis), low = vector_of(b.low), high = vector_of(b.high);
  const double middle = 0.5 * axis.dot(low + high), reach = 0.5 * axis.cwiseAbs().dot(high - low);
  const double nearest = middle - reach - a.high_along, farthest = middle + reach - a.low_along;
  const double longest = (vector_of(b.centre) - vector_of(a.centre)).norm() + a.radius + b.radius;
  const double cosine = std::cos(a.cone), sine = std::sin(a.cone);
  if (nearest * cosine - longest * sine > 0.0) return Facing::all;
  if (farthest * cosine + longest * sine <= flat_cosine * longest + rounding) return Facing::none;
  return Facing::some;
}

bool well_separated(const Cluster& a, const Cluster& b, float separation) {
  return a.radius + b.radius < separation * (vector_of(b.centre) - vector_of(a.centre)).norm();
}

float exchange_bound(const Cluster& a, const Cluster& b) {
  const Vector between = vector_of(b.centre) - vector_of(a.centre);
  const double distance = between.norm(), spread = (a.radius + b.radius) / distance;
  const auto cosine = [&](const Cluster& c) {
    const double widest = std::sin(std::min(static_cast<double>(c.cone), 0.5 * pi));
    return std::min(1.0, std::fabs(vector_of(c.axis).dot(between)) / distance + widest + spread);
  };
  return static_cast<float>(std::max(a.area, b.area) * cosine(a) * cosine(b) / (pi * distance * distance));
}

} // namespace pointgi
