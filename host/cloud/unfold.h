#pragma once
/// Where a neighbour lies when the surface between is laid flat on a point's tangent plane.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pointgi {

/// A point's tangent plane: right-handed (u, v, n).
struct TangentFrame {
  Eigen::Vector3d u, v, n;

  explicit TangentFrame(const Eigen::Vector3d& normal) : n(normal) {
    // Duff et al. 2017: no branch, no square root, defined for every unit normal.
    const double sign = std::copysign(1.0, n.z()), a = -1.0 / (sign + n.z()), b = n.x() * n.y() * a;
    u = {1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    v = {b, sign + n.y() * n.y() * a, -n.y()};
  }
  Eigen::Vector2d flat(const Eigen::Vector3d& e) const { return {e.dot(u), e.dot(v)}; }
};

namespace detail {

constexpr double crease_cosine = 0.866; // 30°: between the curvature of a well sampled surface and an edge
constexpr double other_side = -0.3;     // normals further apart belong to another sheet, or to the back of a blade
constexpr double steepest = 0.7;        // height over length from which a neighbour is on another layer

/// Across an edge: the shortest path over the line in which the two tangent planes meet. False when that line does not
/// lie between the two points, so that there is no such edge.
inline bool unfold_crease(const TangentFrame& at, const Eigen::Vector3d& n, const Eigen::Vector3d& e, double cosine,
                          Eigen::Vector2d& offset) {
  const Eigen::Vector3d cross = at.n.cross(n);
  const double sine = cross.norm();
  if (!(sine > 1e-6)) return false;
  const Eigen::Vector3d line = cross / sine;
  const double length = e.norm();
  const double to_line = e.dot(n) / sine, from_line = -e.dot(at.n) / sine; // signed alike when the line is between
  if (to_line * from_line < 0 && std::min(std::abs(to_line), std::abs(from_line)) > 0.1 * length) return false;
  const double along = e.dot(line);
  const double across = std::sqrt(std::max(0.0, length * length - along * along));
  // For a given chord the path is longest when the edge is half-way: a bound that also tames wrong normals.
  const double path = std::clamp(std::abs(to_line + from_line), across, across / std::sqrt(0.5 * (1.0 + cosine)));
  offset = at.flat(along * line + std::copysign(path, to_line + from_line) * line.cross(at.n));
  return true;
}

} // namespace detail

/// Lays the neighbour at `e` from the frame's point, with unit normal `n`, into the tangent plane: `offset` has the
/// length of the path along the surface (as seen alike from both ends) and leaves in its direction. `spacing`: the
/// usual distance of neighbours here. False when the neighbour is not on the same piece of surface: on the other side
/// of a thin sheet, or on another layer straight above or below.
inline bool unfold(const TangentFrame& at, const Eigen::Vector3d& n, const Eigen::Vector3d& e, double spacing,
                   Eigen::Vector2d& offset) {
  const double cosine = at.n.dot(n);
  if (cosine < detail::other_side) return false;
  if (cosine < detail::crease_cosine && detail::unfold_crease(at, n, e, cosine, offset)) return true;
  // Smooth: what the chord has in the plane half-way between the two tangent planes, so that noise along the normals
  // does not lengthen it, and then the arc over that chord: asin(t)/t with t = sin of half the angle of the normals.
  const Eigen::Vector3d middle = at.n + n;
  const double along = e.dot(middle), height2 = along * along / middle.squaredNorm();
  const double chord2 = std::max(0.0, e.squaredNorm() - height2);
  if (height2 > std::max(detail::steepest * detail::steepest * chord2, spacing * spacing)) return false;
  const double t2 = cosine < detail::crease_cosine ? 0.0 : std::max(0.0, 0.5 * (1.0 - cosine));
  offset = at.flat(e);
  const double flat2 = offset.squaredNorm();
  if (!(flat2 > 1e-12 * spacing * spacing)) return false; // straight above: no direction to go
  offset *= std::sqrt(chord2 / flat2) * (1.0 + t2 * (1.0 / 6.0 + t2 * (3.0 / 40.0)));
  return true;
}

/// No offset that unfold() gives for a neighbour at this squared distance is shorter than the root of this: its height
/// over the plane is bounded.
inline double shortest_path2(double distance2, double spacing) {
  return std::min(distance2 / (1.0 + detail::steepest * detail::steepest), distance2 - spacing * spacing);
}

/// The same for a neighbour at `e` with normal `n`.
inline double shortest_path2(const TangentFrame& at, const Eigen::Vector3d& n, const Eigen::Vector3d& e) {
  const Eigen::Vector3d middle = at.n + n;
  const double along = e.dot(middle);
  return e.squaredNorm() - along * along / middle.squaredNorm(); // NaN for opposed normals, which compares as short
}

} // namespace pointgi
