#pragma once
/// Whether a cloud is what one scanner or depth camera sees from a place.
#include "host/cloud/knn.h"

namespace pointgi {

struct SensorView {
  double one_depth = 0;   ///< share of points whose neighbours as seen from the sensor are neighbours in space, too
  double range_ratio = 1; ///< distance of the farthest quarter over that of the nearest
  double evenness = -1;   ///< d log(angle between neighbours) / d log(distance): 0 for a scanner, -1 for a surface that
                          ///< is sampled evenly by itself; means nothing where range_ratio is near 1
  bool lattice = false;   ///< seen along an axis, the points lie in rows and columns, as pixels do
  bool all_around = false; ///< the sensor is inside the cloud
  double away = 1;         ///< distance of the sensor from the middle of the cloud over the size of the cloud

  /// Strict: an object about the origin, or terrain far above it, must not pass for a scan.
  bool convincing() const;
};

/// Looks at up to 60,000 of the sites. `sensor`: local units. Fewer than 100 sites tell nothing.
SensorView sensor_view(const Sites& sites, const Eigen::Vector3d& sensor);

} // namespace pointgi
