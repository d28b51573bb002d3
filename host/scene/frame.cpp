#include "host/scene/frame.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

Frame frame_of(const PointCloud& cloud) {
  constexpr std::size_t grain = 1 << 16;
  struct Bounds {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  };
  std::vector<Bounds> bounds((cloud.size() + grain - 1) / grain);
  parallel_ranges(cloud.size(), grain, [&](std::size_t begin, std::size_t end) {
    Bounds b;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d n = cloud.normal[i].cast<double>();
      const Eigen::Vector3d half =
          static_cast<double>(cloud.radius[i]) * (1.0 - n.array().square()).max(0.0).sqrt().matrix();
      b.low = b.low.cwiseMin(cloud.position[i] - half);
      b.high = b.high.cwiseMax(cloud.position[i] + half);
    }
    bounds[begin / grain] = b;
  });
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (const Bounds& b : bounds) {
    low = low.cwiseMin(b.low);
    high = high.cwiseMax(b.high);
  }
  const double extent = (high - low).maxCoeff();
  constexpr double below = 0.0137, above = 0.0211;
  Frame frame;
  frame.side = extent * (1.0 + below + above);
  frame.origin = low - Eigen::Vector3d::Constant(extent * below);
  return frame;
}

} // namespace pointgi
