#include "host/cloud/drop_points.h"
#include "host/cloud/keep_points.h"
#include "host/cloud/quantile.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

// A root cube a thousand times the object's size still leaves it 2000 of the finest cells on a side; beyond that the
// object itself would be lost in rounding.
constexpr double outlier_distance = 1000.0; // sizes of the rest
constexpr double outlier_share = 1e-3;
constexpr std::size_t least_points = 1000; // fewer do not tell what the rest is

bool positive(float value) {
  return std::isnormal(value) && value > 0;
}

} // namespace

std::size_t drop_unusable_points(PointCloud& cloud, const CompleteOptions& options) {
  const bool use_radius = !cloud.radius.empty() && options.radii != RadiusSource::estimate;
  const auto usable = [&](std::size_t i) {
    if (!cloud.position[i].allFinite()) return false;
    if (!cloud.colour.empty() && !cloud.colour[i].allFinite()) return false;
    if (!cloud.area.empty() && !positive(cloud.area[i])) return false;
    if (!cloud.opacity.empty() && !(cloud.opacity[i] >= least_opacity)) return false;
    return !use_radius || positive(cloud.radius[i]);
  };

  return keep_points(cloud, usable);
}

std::size_t drop_outliers(PointCloud& cloud) {
  if (cloud.size() < least_points) return 0;
  std::array<Eigen::Vector3d, 2> bounds; // without the outermost hundredth of the points on each side of each axis
  const std::size_t cut = cloud.size() / 100;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = [&](std::size_t i) { return cloud.position[i][axis]; };
    bounds[0][axis] = value_at_rank(cloud.size(), cut, value);
    bounds[1][axis] = value_at_rank(cloud.size(), cloud.size() - 1 - cut, value);
  }
  const Eigen::Vector3d middle = 0.5 * (bounds[0] + bounds[1]);
  const double far = outlier_distance * (bounds[1] - bounds[0]).maxCoeff();
  if (!(far > 0.0)) return 0;
  const auto near = [&](std::size_t i) { return (cloud.position[i] - middle).cwiseAbs().maxCoeff() <= far; };
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    outliers += near(i) ? 0u : 1u;
  // More than a few are a second object, however far off.
  return static_cast<double>(outliers) <= outlier_share * static_cast<double>(cloud.size()) ? keep_points(cloud, near)
                                                                                            : 0;
}

} // namespace pointgi
