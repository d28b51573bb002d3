#include "host/cloud/geographic.h"
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Metres a degree of longitude and of latitude, at a latitude in degrees: radii of curvature of WGS 84.
Eigen::Vector2d metres_a_degree(double latitude) {
  constexpr double semi_major = 6378137.0, flattening = 1.0 / 298.257223563;
  constexpr double squared_eccentricity = flattening * (2.0 - flattening);
  const double phi = latitude * pi / 180.0;
  const double w = 1.0 - squared_eccentricity * std::sin(phi) * std::sin(phi);
  const double prime_vertical = semi_major / std::sqrt(w);
  const double meridian = prime_vertical * (1.0 - squared_eccentricity) / w;
  return Eigen::Vector2d(prime_vertical * std::cos(phi), meridian) * (pi / 180.0);
}

} // namespace

std::optional<Placement> degrees_to_metres(const std::vector<Eigen::Vector3d>& positions, bool declared) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(infinite), high = -low;
  for (const Eigen::Vector3d& p : positions)
    if (p.allFinite()) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  // Longitudes are counted from -180 or from 0; at a pole a degree of longitude is no length.
  const bool in_range = low.x() >= -180.0 && high.x() <= 360.0 && low.y() > -89.9 && high.y() < 89.9;
  if (!in_range) return std::nullopt;
  const Eigen::Vector3d extent = high - low;
  if (!declared && !(extent.z() > 300.0 * std::max(extent.x(), extent.y()) && extent.x() > 0.0 && extent.y() > 0.0))
    return std::nullopt;
  const Eigen::Vector2d metres = metres_a_degree((low.y() + high.y()) / 2.0);
  return Placement{low, high, {metres.x(), metres.y(), 1.0}};
}

} // namespace pointgi
