#include "host/view/ground.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double overlap = 1.1; // as sampled shapes have it
constexpr double finest = 0.04; // width of a ring below the points, in units of their radius
constexpr double growth = 0.12; // of a ring's width with its radius, outside
constexpr double widest = 4.0;

/// Bounds of the points across and along up.
struct Footprint {
  Vector3d centre; ///< on the ground
  double radius = 0.0, height = 0.0;
};

Footprint footprint_of(const ViewPoints& points, const Vector3d& up) {
  const Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  Vector3d low = Vector3d::Constant(INFINITY), high = -low;
  for (const Vector3d& p : points.position) {
    if (!points.in_frame(p)) continue;
    const Vector3d q(u.dot(p), v.dot(p), up.dot(p));
    low = low.cwiseMin(q), high = high.cwiseMax(q);
  }
  const Vector3d middle = 0.5 * (low + high);
  const double height = high.z() - low.z();
  const double radius = std::max({0.5 * (high.x() - low.x()), 0.5 * (high.y() - low.y()), 0.1 * height});
  // A little lower, or it would lie in one plane with flat feet.
  return {middle.x() * u + middle.y() * v + (low.z() - 0.002 * std::max(height, radius)) * up, radius, height};
}

} // namespace

bool has_ground(const ViewPoints& points, const Vector3d& up) {
  constexpr int cells = 12;
  const Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  const Footprint all = footprint_of(points, up);
  const double side = 2.0 * all.radius;
  std::array<char, cells * cells> low{}, any{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d d = points.position[i] - all.centre;
    const double x = d.dot(u) / side + 0.5, y = d.dot(v) / side + 0.5;
    if (!points.in_frame(points.position[i]) || x < 0.0 || x >= 1.0 || y < 0.0 || y >= 1.0) continue;
    const auto cell = static_cast<std::size_t>(y * cells) * cells + static_cast<std::size_t>(x * cells);
    any[cell] = 1;
    if (d.dot(up) < 0.12 * all.height && up.dot(points.normal[i].cast<double>()) > 0.7) low[cell] = 1;
  }
  const auto filled = std::count(any.begin(), any.end(), 1);
  return 2 * std::count(low.begin(), low.end(), 1) > filled;
}

PointCloud ground_under(const ViewPoints& points, const Vector3d& up) {
  const Footprint foot = footprint_of(points, up);
  const Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  PointCloud ground;
  const auto add = [&](double from_centre, double turn, double radius, double area) {
    ground.position.emplace_back(foot.centre + from_centre * (std::cos(turn) * u + std::sin(turn) * v));
    ground.normal.push_back(up.cast<float>());
    ground.radius.push_back(static_cast<float>(overlap * radius));
    ground.area.push_back(static_cast<float>(area));
  };
  const double least = finest * foot.radius;
  add(0.0, 0.0, 0.5 * least, 0.25 * pi * least * least);
  double inner = 0.5 * least;
  for (int ring = 0; inner < widest * foot.radius; ++ring) {
    const double width = std::max(least, growth * (inner - 1.3 * foot.radius) + least), outer = inner + width;
    const double middle = 0.5 * (inner + outer), count = std::round(2.0 * pi * middle / width);
    const double half_cell = pi / count; // corners of a cell, outside and in
    const double reach = std::max(std::hypot(outer * std::cos(half_cell) - middle, outer * std::sin(half_cell)),
                                  std::hypot(inner * std::cos(half_cell) - middle, inner * std::sin(half_cell)));
    for (double i = 0; i < count; ++i)
      add(middle, (2.0 * i + ring) * half_cell, reach, pi * (outer * outer - inner * inner) / count);
    inner = outer;
  }
  return ground;
}

} // namespace pointgi
