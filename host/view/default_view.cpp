#include "host/view/default_view.h"
#include "host/scene/lighting.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pointgi {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
/// Room left at the border of the frame.
constexpr double frame_margin = 1.06;

struct Survey {
  Vector3d low, high;   ///< bounds without the outermost half percent of the points on each axis
  Vector3d mean_normal; ///< sum of A n over the sum of A: zero for a closed surface
};

Survey survey(const PointCloud& cloud) {
  Survey result;
  std::vector<double> values(cloud.size());
  for (int a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < cloud.size(); ++i)
      values[i] = cloud.position[i][a];
    const auto at = [&](std::size_t k) {
      std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
      return values[k];
    };
    const std::size_t cut = cloud.size() / 200;
    result.low[a] = at(cut);
    result.high[a] = at(cloud.size() - 1 - cut);
  }
  Vector3d sum(0, 0, 0);
  double area = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    sum += static_cast<double>(cloud.area[i]) * cloud.normal[i].cast<double>();
    area += cloud.area[i];
  }
  result.mean_normal = sum / area;
  return result;
}

/// Terrain: much flatter than wide, facing along its thin axis. Returns that direction, or zero.
Vector3d terrain_up(const Survey& s) {
  const Vector3d extent = s.high - s.low;
  int thin = 0;
  extent.minCoeff(&thin);
  const double middle = extent.sum() - extent.minCoeff() - extent.maxCoeff();
  if (extent[thin] > 0.35 * middle || std::fabs(s.mean_normal[thin]) < 0.5) return Vector3d::Zero();
  return Vector3d::Unit(thin) * (s.mean_normal[thin] > 0.0 ? 1.0 : -1.0);
}

/// What the splats would stand on with `up` (plus or minus an axis) upwards: the bounding rectangle of their lowest
/// fiftieth, as a share of the whole's; 0 where the middle of the points is not above it.
double footprint(const PointCloud& cloud, const Survey& s, int axis, double sign) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const Vector3d extent = s.high - s.low;
  const double floor = sign > 0.0 ? s.low[axis] : -s.high[axis];
  double low_a = INFINITY, high_a = -INFINITY, low_b = INFINITY, high_b = -INFINITY;
  Vector3d middle(0, 0, 0);
  for (const Vector3d& p : cloud.position) {
    middle += p;
    if (sign * p[axis] > floor + 0.02 * extent[axis]) continue;
    low_a = std::min(low_a, p[a]), high_a = std::max(high_a, p[a]);
    low_b = std::min(low_b, p[b]), high_b = std::max(high_b, p[b]);
  }
  middle /= static_cast<double>(cloud.size());
  if (middle[a] < low_a || middle[a] > high_a || middle[b] < low_b || middle[b] > high_b) return 0.0;
  return (high_a - low_a) * (high_b - low_b) / (extent[a] * extent[b]);
}

/// The axis that points up: whichever of y and z the points stand on most broadly; y, as models have it, when they
/// stand on neither.
Vector3d standing_up(const PointCloud& cloud, const Survey& s) {
  constexpr double least = 0.2; // a foot this small is a tip that the middle happens to be above
  Vector3d best = Vector3d::UnitY();
  double widest = least;
  for (const int axis : {1, 2})
    for (const double sign : {1.0, -1.0})
      if (const double foot = footprint(cloud, s, axis, sign); foot > widest) {
        widest = foot;
        best = sign * Vector3d::Unit(axis);
      }
  return best;
}

/// Where the front is, a little from the right: across the longer side; towards +z with y up and -y with z up, as
/// models have it.
Vector3d front_of(const Survey& s, const Vector3d& up) {
  const bool y_up = std::fabs(up.y()) > 0.5;
  const Vector3d extent = s.high - s.low, depth_axis = y_up ? Vector3d(0, 0, 1) : Vector3d(0, -1, 0);
  const double depth = y_up ? extent.z() : extent.y();
  const Vector3d front = depth > 1.25 * extent.x() ? Vector3d(1, 0, 0) : depth_axis;
  return front + 0.5 * up.cross(front);
}

/// Moves the camera back along its view until the points inside the bounds fill the frame.
void fit(Scene& scene, const PointCloud& cloud, const Survey& s, const Vector3d& from, const Vector3d& up) {
  const Vector3d back = from.normalized(), right = up.cross(back).normalized(), upward = back.cross(right);
  const Vector3d centre = 0.5 * (s.low + s.high), slack = 0.02 * (s.high - s.low);
  const double half_y = std::tan(0.5 * scene.camera.fov_deg * degree) / frame_margin;
  const double half_x = half_y * scene.render.width / scene.render.height;
  double distance = 1e-9 * (1.0 + (s.high - s.low).norm());
  double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
  for (int pass = 0; pass < 2; ++pass) {
    // First pass: the middle of what is seen; second: how far away it fits.
    const Vector3d target =
        pass == 0 ? centre : Vector3d(centre + 0.5 * (low_x + high_x) * right + 0.5 * (low_y + high_y) * upward);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vector3d& p = cloud.position[i];
      if ((p.array() < (s.low - slack).array()).any() || (p.array() > (s.high + slack).array()).any()) continue;
      const Vector3d d = p - target;
      const double x = d.dot(right), y = d.dot(upward), z = d.dot(back), r = cloud.radius[i];
      if (pass == 0) {
        low_x = std::min(low_x, x), high_x = std::max(high_x, x);
        low_y = std::min(low_y, y), high_y = std::max(high_y, y);
      } else {
        distance = std::max({distance, z + (std::fabs(x) + r) / half_x, z + (std::fabs(y) + r) / half_y, z + 2.0 * r});
      }
    }
    scene.camera.look_at = target;
  }
  scene.camera.position = scene.camera.look_at + distance * back;
  scene.camera.up = upward;
}

/// A depth image is looked at from its sensor, at the origin of its coordinates; y runs downwards, as depth cameras
/// count.
void look_from_sensor(Scene& scene, const PointCloud& cloud, const Survey& s) {
  Vector3d forward = (0.5 * (s.low + s.high)).normalized();
  const Vector3d down = std::fabs(forward.y()) < 0.9 ? Vector3d(0, 1, 0) : Vector3d(0, 0, -1);
  Vector3d right, upward;
  double tangent_x = 0.0, tangent_y = 0.0;
  for (int pass = 0; pass < 3; ++pass) { // turns towards the middle of what is seen, then measures it
    right = down.cross(forward).normalized();
    upward = right.cross(forward);
    double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
    for (const Vector3d& p : cloud.position) {
      const double z = p.dot(forward);
      if (z <= 0.0 || (p.array() < s.low.array()).any() || (p.array() > s.high.array()).any()) continue;
      const double x = p.dot(right) / z, y = p.dot(upward) / z;
      low_x = std::min(low_x, x), high_x = std::max(high_x, x);
      low_y = std::min(low_y, y), high_y = std::max(high_y, y);
    }
    tangent_x = std::max(high_x, -low_x), tangent_y = std::max(high_y, -low_y);
    if (pass < 2) forward = (forward + 0.5 * (low_x + high_x) * right + 0.5 * (low_y + high_y) * upward).normalized();
  }
  const double tangent = std::max({0.05, tangent_y, tangent_x * scene.render.height / scene.render.width});
  scene.camera.position = Vector3d::Zero();
  scene.camera.look_at = forward * (0.5 * (s.low + s.high)).norm();
  scene.camera.up = upward;
  scene.camera.fov_deg = std::min(120.0, 2.0 * std::atan(frame_margin * tangent) / degree);
}

} // namespace

void choose_lights(Scene& scene) {
  const Vector3d back = (scene.camera.position - scene.camera.look_at).normalized(), up = up_of(scene);
  const Vector3d right = up.cross(back).normalized();
  const Vector3d towards = (-0.55 * right + 0.7 * up + 0.75 * back).normalized();
  LightSettings key;
  key.type = LightType::directional;
  key.is_far = true;
  key.vector = towards;
  key.strength = Vector3d(2.0, 1.95, 1.85);
  scene.lights = {key};
  scene.environment = Vector3d(0.20, 0.215, 0.245);
}

std::string choose_camera(Scene& scene, const WorldSplats& splats) {
  const Survey s = survey(splats.cloud);
  const std::string normals = splats.reports.empty() ? "" : splats.reports.front().normals_from;
  std::string said;
  if (normals.find("sensor at the origin") != std::string::npos) {
    look_from_sensor(scene, splats.cloud, s);
    said = "seen from the sensor at the origin";
  } else if (const Vector3d up = terrain_up(s); !up.isZero() && (!scene.up_chosen || up.dot(up_of(scene)) > 0.5)) {
    const Vector3d level = std::fabs(up.z()) > 0.5 ? Vector3d(0, -1, 0) : Vector3d(0, 0, 1);
    fit(scene, splats.cloud, s, std::sin(50.0 * degree) * up + std::cos(50.0 * degree) * level, up);
    said = "terrain, seen from above";
  } else {
    const Vector3d up_axis = scene.up_chosen ? up_of(scene) : standing_up(splats.cloud, s);
    // An open scan faces the way it was scanned from.
    const Vector3d open = s.mean_normal - s.mean_normal.dot(up_axis) * up_axis;
    const bool is_open = open.norm() > 0.15;
    fit(scene, splats.cloud, s, (is_open ? open : front_of(s, up_axis)).normalized() + 0.25 * up_axis, up_axis);
    int axis = 0;
    up_axis.cwiseAbs().maxCoeff(&axis);
    said = std::string(up_axis.sum() < 0.0 ? "-" : "") + "xyz"[axis] + " taken as up, seen from " +
           (is_open ? "the side that most points face" : "the front");
  }
  const Vector3d &p = scene.camera.position, &t = scene.camera.look_at;
  char text[256];
  std::snprintf(text, sizeof text,
                "camera chosen: %s (position = [%.6g, %.6g, %.6g], look_at = [%.6g, %.6g, %.6g], fov_deg = %.4g)",
                said.c_str(), p.x(), p.y(), p.z(), t.x(), t.y(), t.z(), scene.camera.fov_deg);
  return text;
}

} // namespace pointgi
