#include "host/view/up.h"
#include "host/view/standing.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

UpChoice of_axis(int axis, double sign, const char* reason) {
  return {sign * Vector3d::Unit(axis), reason};
}

/// Area of what is level with `up` upwards, turned up or down alike; `from`, `to`: shares of the height within which it
/// lies.
double level_area(const ViewPoints& points, const Vector3d& up, double from, double to) {
  constexpr double level = 0.95;
  const double a = up.dot(points.low), b = up.dot(points.high), bottom = std::min(a, b), height = std::fabs(a - b);
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double h = (up.dot(points.position[i]) - bottom) / height;
    if (h >= from && h <= to && std::fabs(up.dot(points.normal[i].cast<double>())) > level) area += points.area[i];
  }
  return area;
}

UpChoice of_terrain(const ViewPoints& points) {
  int thin = 0;
  points.extent().minCoeff(&thin);
  return of_axis(thin, points.mean_normal[thin] < -0.5 ? -1.0 : 1.0, "the terrain is flat across it");
}

UpChoice of_room(const ViewPoints& points) {
  constexpr double clearly = 1.2;
  const double y = level_area(points, Vector3d::UnitY(), -1.0, 2.0);
  const double z = level_area(points, Vector3d::UnitZ(), -1.0, 2.0);
  return of_axis(y > clearly * z ? 1 : 2, 1.0, "most floor and ceiling lie across it");
}

/// What faces up less what faces down, of a surface that faces the eye: floors and tables less ceilings. Frames are
/// seldom level, so that more than what is level counts. As a share of the whole area.
double facing_up(const ViewPoints& points, const Vector3d& up, const Vector3d& eye) {
  constexpr double steep = 0.4;
  double sum = 0.0, area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d normal = points.normal[i].cast<double>();
    const double towards_eye = normal.dot(eye - points.position[i]),
                 facing = std::copysign(1.0, towards_eye) * normal.dot(up);
    area += points.area[i];
    if (std::fabs(facing) > steep) sum += points.area[i] * facing;
  }
  return sum / area;
}

/// Cameras look along z and count y downwards, or look along -z with y upwards; what looks along x or y is a scanner
/// with z upwards.
UpChoice of_depth_frame(const ViewPoints& points, const Vector3d& eye) {
  constexpr double clear = 0.05;
  const Vector3d ahead = points.centre() - eye;
  int forward = 0;
  ahead.cwiseAbs().maxCoeff(&forward);
  if (forward != 2) return of_axis(2, 1.0, "the sensor looks across it");
  const double share = facing_up(points, Vector3d::UnitY(), eye);
  if (std::fabs(share) < clear) return of_axis(1, ahead.z() > 0.0 ? -1.0 : 1.0, "as depth cameras count");
  return of_axis(1, share > 0.0 ? 1.0 : -1.0, "more faces it than away from it");
}

/// The largest share of the points in one layer of a fiftieth of the height, in the lower third.
double bottom_layer(const ViewPoints& points, const Vector3d& up) {
  constexpr int layers = 50;
  const double a = up.dot(points.low), b = up.dot(points.high), bottom = std::min(a, b), height = std::fabs(a - b);
  std::array<std::size_t, layers> count{};
  for (const Vector3d& p : points.position) {
    const double h = layers * (up.dot(p) - bottom) / height;
    if (h >= 0.0 && h < layers) ++count[static_cast<std::size_t>(h)];
  }
  return static_cast<double>(*std::max_element(count.begin(), count.begin() + layers / 3)) /
         static_cast<double>(points.size());
}

constexpr const char* usual_reason = "as files of this format count";

bool stands_flat(const ViewPoints& points, const Vector3d& up) {
  constexpr double broad = 0.2, flat = 0.05;
  int axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  const Support support = support_of(points, axis, up[axis]);
  return support.footprint > broad && support.flat > flat;
}

UpChoice of_sparse(const ViewPoints& points) {
  // Programs of structure from motion count y downwards as their cameras do; those that level their points, z upwards.
  constexpr double clearly = 1.3;
  Vector3d best = -Vector3d::UnitY();
  double most = bottom_layer(points, best);
  for (const Vector3d& up : {Vector3d(Vector3d::UnitZ()), Vector3d(Vector3d::UnitY())})
    if (const double layer = bottom_layer(points, up); layer > clearly * most) {
      most = layer;
      best = up;
    }
  return {best, "a level layer of points is below"};
}

} // namespace

UpChoice find_up(const ViewPoints& points, CloudKind kind, const Vector3d& eye, const std::optional<Vector3d>& usual) {
  switch (kind) {
  case CloudKind::station:
  case CloudKind::map:
    return of_axis(2, 1.0, "as scans of land have it");
  case CloudKind::terrain:
    return of_terrain(points);
  case CloudKind::room:
    return of_room(points);
  case CloudKind::depth_frame:
    return of_depth_frame(points, eye);
  case CloudKind::sparse:
    return usual ? UpChoice{*usual, usual_reason} : of_sparse(points);
  case CloudKind::model:
  case CloudKind::foliage:
    break;
  }
  const UpChoice standing = standing_up(points);
  return usual && !stands_flat(points, standing.up) ? UpChoice{*usual, usual_reason} : standing;
}

} // namespace pointgi
