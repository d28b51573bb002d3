#pragma once
/// World units in double <-> the root cube [0,1)^3 in float.
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// world = origin + side * cube, per axis.
struct Frame {
  Eigen::Vector3d origin{0, 0, 0};
  double side = 1.0;

  Eigen::Vector3f to_cube(const Eigen::Vector3d& world) const { return ((world - origin) / side).cast<float>(); }
  Eigen::Vector3d to_world(const Eigen::Vector3f& cube) const { return origin + side * cube.cast<double>(); }
};

/// The smallest such cube that holds every disc of the cloud, a little to spare. The spare differs below and above, so
/// that the planes that people build with (floors, middles of boxes) do not fall onto cell borders, where each splat
/// would be listed in the cells of both sides. Needs normals and radii.
Frame frame_of(const PointCloud& cloud);

} // namespace pointgi
