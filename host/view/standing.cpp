#include "host/view/standing.h"
#include <algorithm>
#include <bitset>
#include <cmath>

namespace pointgi {

namespace {

constexpr int y_axis = 1, z_axis = 2;

Vector3d middle_of(const ViewPoints& points) {
  Vector3d sum(0, 0, 0);
  for (const Vector3d& p : points.position)
    sum += p;
  return sum / static_cast<double>(points.size());
}

/// How well a model stands along an axis, either way up. What is made to stand on feet fills little of what it stands
/// on; lying on its back it would fill more.
double standing_along(const Support& upright, const Support& inverted) {
  const Support& broader = upright.footprint >= inverted.footprint ? upright : inverted;
  return broader.footprint * (1.5 - 0.5 * broader.filled);
}

/// Standing on its head: nothing to stand on at the lower end, a broad flat foot at the upper.
bool is_inverted(const Support& upright, const Support& inverted) {
  return upright.footprint < 0.15 && upright.flat < 0.02 && inverted.footprint > 0.25 && inverted.flat > 0.25;
}

} // namespace

Support support_of(const ViewPoints& points, int axis, double sign) {
  constexpr int cells = 16;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const Vector3d extent = points.extent(), middle = middle_of(points);
  const double floor = sign > 0.0 ? points.low[axis] : -points.high[axis];
  const auto is_low = [&](const Vector3d& p) { return sign * p[axis] <= floor + 0.02 * extent[axis]; };
  double low_a = INFINITY, high_a = -INFINITY, low_b = INFINITY, high_b = -INFINITY, flat = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d& p = points.position[i];
    if (!is_low(p)) continue;
    low_a = std::min(low_a, p[a]), high_a = std::max(high_a, p[a]);
    low_b = std::min(low_b, p[b]), high_b = std::max(high_b, p[b]);
    if (sign * points.normal[i][axis] < -0.9f) flat += points.area[i];
  }
  const double whole = extent[a] * extent[b];
  Support support;
  support.flat = whole > 0.0 ? flat * points.scale_of_area / whole : 0.0;
  if (middle[a] < low_a || middle[a] > high_a || middle[b] < low_b || middle[b] > high_b || !(whole > 0.0))
    return support;
  support.footprint = (high_a - low_a) * (high_b - low_b) / whole;
  std::bitset<cells * cells> met;
  const auto cell = [](double x, double low, double high) {
    return static_cast<std::size_t>(std::clamp(cells * (x - low) / (high - low), 0.0, cells - 1.0));
  };
  for (const Vector3d& p : points.position)
    if (is_low(p) && high_a > low_a && high_b > low_b)
      met.set(cells * cell(p[a], low_a, high_a) + cell(p[b], low_b, high_b));
  support.filled = static_cast<double>(met.count()) / (cells * cells);
  return support;
}

double asymmetry_about(const ViewPoints& points, int axis) {
  const Vector3d middle = middle_of(points), extent = points.extent();
  Vector3d second(0, 0, 0), third(0, 0, 0);
  double mixed = 0.0;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  for (const Vector3d& p : points.position) {
    const Vector3d d = p - middle;
    second += d.cwiseProduct(d);
    third += d.cwiseProduct(d).cwiseProduct(d);
    mixed += d[a] * d[b];
  }
  second /= static_cast<double>(points.size());
  third /= static_cast<double>(points.size());
  mixed /= static_cast<double>(points.size());
  const auto skew = [&](int k) { return std::fabs(third[k]) / std::pow(second[k] + 1e-300, 1.5); };
  const double unlike = std::fabs(second[a] - second[b]) / (second[a] + second[b] + 1e-300);
  return unlike + std::fabs(mixed) / std::sqrt(second[a] * second[b] + 1e-300) + 0.5 * (skew(a) + skew(b)) +
         std::fabs(extent[a] - extent[b]) / (extent[a] + extent[b] + 1e-300);
}

UpChoice standing_up(const ViewPoints& points) {
  constexpr double least = 0.2;    // a foot this small is a tip that the middle happens to be above
  constexpr double clearly = 1.05; // y is the custom of models
  constexpr double symmetric = 0.12;
  const Support up[] = {support_of(points, y_axis, 1.0), support_of(points, z_axis, 1.0)};
  const Support down[] = {support_of(points, y_axis, -1.0), support_of(points, z_axis, -1.0)};
  const double along_y = standing_along(up[0], down[0]), along_z = standing_along(up[1], down[1]);
  const double about_y = asymmetry_about(points, y_axis), about_z = asymmetry_about(points, z_axis);
  const bool stands = std::max(along_y, along_z) > least;
  const char* reason = "what it stands on is across it";
  bool is_z = along_z > clearly * along_y;
  if (!stands) {
    is_z = about_z < symmetric && about_y > 2.0 * about_z;
    reason =
        is_z || (about_y < symmetric && about_z > 2.0 * about_y) ? "it is symmetric about it" : "as models have it";
  }
  const int which = is_z ? 1 : 0;
  const double sign = is_inverted(up[which], down[which]) ? -1.0 : 1.0;
  return {sign * Vector3d::Unit(is_z ? z_axis : y_axis), reason};
}

} // namespace pointgi
