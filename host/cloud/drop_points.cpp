#include "host/cloud/drop_points.h"
#include "host/cloud/keep_points.h"
#include "host/cloud/quantile.h"
#include "octree/parallel.h"
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

template <class Wanted>
std::size_t count_unwanted(std::size_t n, const Wanted& wanted) {
  return parallel_sum(n, 1 << 16, std::size_t{0}, [&](std::size_t& count, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      count += wanted(i) ? 0u : 1u;
  });
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
  // Most clouds need no copy. Faces may name points that do not exist, which keep_points() removes.
  if (cloud.triangle.empty() && count_unwanted(cloud.size(), usable) == 0) return 0;
  return keep_points(cloud, usable);
}

std::size_t drop_outliers(PointCloud& cloud) {
  if (cloud.size() < least_points) return 0;
  const std::size_t cut = cloud.size() / 100; // the outermost points on each side of each axis do not count
  const auto bounds = bounds_at_ranks(cloud.size(), cut, cloud.size() - 1 - cut,
                                      [&](std::size_t i) -> const Eigen::Vector3d& { return cloud.position[i]; });
  const Eigen::Vector3d low = Eigen::Vector3d::Map(bounds[0].data()), high = Eigen::Vector3d::Map(bounds[1].data());
  const Eigen::Vector3d middle = 0.5 * (low + high);
  const double far = outlier_distance * (high - low).maxCoeff();
  if (!(far > 0.0)) return 0;
  const auto near = [&](std::size_t i) { return (cloud.position[i] - middle).cwiseAbs().maxCoeff() <= far; };
  const std::size_t outliers = count_unwanted(cloud.size(), near);
  if (outliers == 0) return 0;
  // More than a few are a second object, however far off.
  return static_cast<double>(outliers) <= outlier_share * static_cast<double>(cloud.size()) ? keep_points(cloud, near)
                                                                                            : 0;
}

} // namespace pointgi
