#include "host/lights/sky_frame.h"
#include <Eigen/Geometry>
#include <cmath>

namespace pointgi {

namespace {

double radians(double degrees) {
  return degrees * 3.14159265358979323846 / 180.0;
}

} // namespace

SkyFrame sky_frame(UpAxis up, double turn_deg) {
  const Vector3d upwards = direction_of(up);
  const Vector3d right = std::fabs(upwards.x()) > 0.5 ? Vector3d::UnitY() : Vector3d::UnitX();
  const Vector3d forward = upwards.cross(right);
  const double c = std::cos(radians(turn_deg)), s = std::sin(radians(turn_deg));
  return {c * right - s * forward, c * forward + s * right, upwards};
}

Vector3d sky_direction(const SkyFrame& frame, double azimuth_deg, double elevation_deg) {
  const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
  return std::cos(elevation) * (std::sin(azimuth) * frame.right + std::cos(azimuth) * frame.forward) +
         std::sin(elevation) * frame.up;
}

} // namespace pointgi
