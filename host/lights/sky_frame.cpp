#include "host/lights/sky_frame.h"
#include <cmath>

namespace pointgi {

namespace {

double radians(double degrees) {
  return degrees * 3.14159265358979323846 / 180.0;
}

} // namespace

SkyFrame sky_frame(UpAxis up, double turn_deg) {
  const Vector3d right = Vector3d::UnitX();
  const Vector3d forward = up == UpAxis::z ? Vector3d(Vector3d::UnitY()) : Vector3d(-Vector3d::UnitZ());
  const double c = std::cos(radians(turn_deg)), s = std::sin(radians(turn_deg));
  return {c * right - s * forward, c * forward + s * right,
          up == UpAxis::z ? Vector3d(Vector3d::UnitZ()) : Vector3d(Vector3d::UnitY())};
}

Vector3d sky_direction(const SkyFrame& frame, double azimuth_deg, double elevation_deg) {
  const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
  return std::cos(elevation) * (std::sin(azimuth) * frame.right + std::cos(azimuth) * frame.forward) +
         std::sin(elevation) * frame.up;
}

} // namespace pointgi
