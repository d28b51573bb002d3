#include "host/scene/frame.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

Frame frame_of(const PointCloud& cloud) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d n = cloud.normal[i].cast<double>();
    const Eigen::Vector3d half =
        static_cast<double>(cloud.radius[i]) * (1.0 - n.array().square()).max(0.0).sqrt().matrix();
    low = low.cwiseMin(cloud.position[i] - half);
    high = high.cwiseMax(cloud.position[i] + half);
  }
  const double extent = (high - low).maxCoeff();
  constexpr double below = 0.0137, above = 0.0211;
  Frame frame;
  frame.side = extent * (1.0 + below + above);
  frame.origin = low - Eigen::Vector3d::Constant(extent * below);
  return frame;
}

} // namespace pointgi
