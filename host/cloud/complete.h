#pragma once
/// From a cloud as the file has it to one with unit normals, radii and effective areas.
#include "host/cloud/point_cloud.h"
#include <optional>

namespace pointgi {

enum class NormalSource {
  automatic, ///< file's if there, else faces', else estimated; flipped as a whole when a closed surface faces inward
  file,      ///< the file's, normalised, never flipped
  estimate,  ///< PCA, whatever the file has
  flip,      ///< the file's, else faces', else estimated ones, turned round once
};
enum class RadiusSource { automatic, file, estimate };

struct CompleteOptions {
  NormalSource normals = NormalSource::automatic;
  RadiusSource radii = RadiusSource::automatic;
  std::optional<Eigen::Vector3d> viewpoint; ///< the sensor: estimated normals are turned towards it
};

/// Drops points that are not finite or have radius <= 0 in the file, then fills normal, radius and area.
/// Afterwards all three arrays are as long as `position`, normals are unit, radii and areas > 0.
/// Throws Error(input) when no point is left. Ends in seconds for any input (coincident, collinear, one far outlier).
void complete_cloud(PointCloud& cloud, const CompleteOptions& options, CloudReport& report);

} // namespace pointgi
