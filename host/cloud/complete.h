#pragma once
/// From a cloud as the file has it to one with unit normals, radii and effective areas.
#include "host/cloud/point_cloud.h"
#include "host/cloud/strays.h"
#include <limits>
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
  StrayPolicy strays = StrayPolicy::drop;
  std::vector<Eigen::Vector3d> eyes; ///< camera and lamps of the scene, the file's coordinates: they see fronts
  std::optional<Eigen::Vector3d> up; ///< unit, the file's coordinates: the user's word; absent: CloudReport::up
  double followed_cosine = std::numeric_limits<double>::infinity(); ///< of BorderEvidence
};

/// Drops points that are not finite or have radius <= 0 in the file, and strays (host/cloud/strays.h) as options.strays
/// says, then fills normal, radius, area, structure and clipped; normals that are given are kept, missing ones (zero,
/// NaN) estimated. Vertices of a mesh without normals become several points where sharp edges meet: copies follow the
/// others, `record` tells of which. Afterwards all four arrays are as long as `position`, normals are unit, radii and
/// areas > 0. `report` receives, too, the kind of cloud and which way is up where the kind or the format shows it.
/// Throws Error(input) when no point is left. Ends in seconds for any input (coincident, collinear, one far outlier).
void complete_cloud(PointCloud& cloud, const CompleteOptions& options, CloudReport& report);

} // namespace pointgi
