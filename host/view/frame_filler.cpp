#include "host/view/frame_filler.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
/// Room left at the border of the frame.
constexpr double frame_margin = 1.08;

/// Bounds of what is seen, across the view.
struct Rectangle {
  double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
  void add(double x, double y) {
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
};

} // namespace

void fill_frame(Scene& scene, const ViewPoints& points, const Vector3d& from, const Vector3d& up, Backfaces backfaces) {
  const Vector3d back = from.normalized(), right = up.cross(back).normalized(), upward = back.cross(right);
  const double half_y = std::tan(0.5 * scene.camera.fov_deg * degree) / frame_margin;
  const double half_x = half_y * scene.render.width / scene.render.height;
  // How far away they fit. Perspective makes what is near large: the middle of the picture is found step by step.
  Vector3d target = points.centre();
  const bool fronts_only = backfaces == Backfaces::see_through;
  const auto counts = [&](std::size_t i) {
    return points.in_frame(points.position[i]) && !(fronts_only && points.normal[i].cast<double>().dot(back) < -0.1);
  };
  double distance = 0.0;
  for (int step = 0; step < 4; ++step) {
    distance = 1e-9 * (1.0 + points.extent().norm());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d d = points.position[i] - target;
      if (!counts(i)) continue;
      const double x = d.dot(right), y = d.dot(upward), z = d.dot(back), r = points.radius[i];
      distance = std::max({distance, z + (std::fabs(x) + r) / half_x, z + (std::fabs(y) + r) / half_y, z + 2.0 * r});
    }
    if (step == 3) break;
    Rectangle seen;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d d = points.position[i] - target;
      const double depth = distance - d.dot(back);
      if (counts(i)) seen.add(d.dot(right) / depth, d.dot(upward) / depth);
    }
    if (!std::isfinite(seen.low_x)) return fill_frame(scene, points, from, up, Backfaces::shade); // all faces away
    target += distance * (0.5 * (seen.low_x + seen.high_x) * right + 0.5 * (seen.low_y + seen.high_y) * upward);
  }
  scene.camera.look_at = target;
  scene.camera.position = target + distance * back;
  scene.camera.up = up;
}

void look_from(Scene& scene, const ViewPoints& points, const Vector3d& eye, const Vector3d& up) {
  Vector3d forward = (points.centre() - eye).normalized();
  const Vector3d across = forward.cross(up);
  const Vector3d upright = across.norm() > 0.02 ? up : Vector3d(forward.unitOrthogonal()); // it looks along up
  double tangent_x = 0.0, tangent_y = 0.0;
  for (int pass = 0; pass < 3; ++pass) { // turns towards the middle of what is seen, then measures it
    const Vector3d right = forward.cross(upright).normalized(), upward = right.cross(forward);
    Rectangle seen;
    for (const Vector3d& p : points.position) {
      const Vector3d d = p - eye;
      const double z = d.dot(forward);
      if (z > 0.0 && points.in_frame(p)) seen.add(d.dot(right) / z, d.dot(upward) / z);
    }
    tangent_x = std::max(seen.high_x, -seen.low_x), tangent_y = std::max(seen.high_y, -seen.low_y);
    if (pass < 2)
      forward =
          (forward + 0.5 * (seen.low_x + seen.high_x) * right + 0.5 * (seen.low_y + seen.high_y) * upward).normalized();
  }
  const double tangent = std::max({0.05, tangent_y, tangent_x * scene.render.height / scene.render.width});
  scene.camera.position = eye;
  scene.camera.look_at = eye + forward * (points.centre() - eye).norm();
  scene.camera.up = upright;
  scene.camera.fov_deg = std::min(120.0, 2.0 * std::atan(frame_margin * tangent) / degree);
}

} // namespace pointgi
