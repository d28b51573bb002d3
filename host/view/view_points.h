#pragma once
/// What of a cloud decides how it is looked at: its surface, without strays.
#include "host/cloud/point_cloud.h"

namespace pointgi {

using Eigen::Vector3d;

/// Points of the surface, every one of a cloud of up to 400,000, else as many spread over the file's order.
struct ViewPoints {
  std::vector<Vector3d> position;
  std::vector<Eigen::Vector3f> normal;
  std::vector<float> radius, area;
  Vector3d low{0, 0, 0}, high{0, 0, 0}; ///< bounds without the outermost points on each axis
  Vector3d mean_normal{0, 0, 0};        ///< sum of A n over the sum of A: zero for a closed surface
  double outwardness = 0.0; ///< sum of A n.(x - c) over the sum of A |x - c|: 1 for a sphere, -1 where it faces inwards
  double scale_of_area = 1.0; ///< area of the whole cloud's surface over that of these points

  std::size_t size() const { return position.size(); }
  Vector3d centre() const { return 0.5 * (low + high); }
  Vector3d extent() const { return high - low; }
  /// Whether a point counts for the frame of a picture: within the bounds and a little.
  bool in_frame(const Vector3d& p) const;
};

/// `cloud`: complete. Where the structure of neighbourhoods is known, points of no surface are left out, unless there
/// is hardly any. `cut`: share of the points beyond each end of the bounds.
ViewPoints view_points(const PointCloud& cloud, double cut);

/// Value below which `share` of the values lie; they are reordered. Not of none.
double quantile(std::vector<double>& values, double share);

} // namespace pointgi
