#pragma once
/// 3D Gaussians, as radiance field training writes them, become discs.
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// What a file says of each Gaussian. Arrays are as long as the cloud's positions, or empty where the file has none.
struct GaussianValues {
  std::vector<Eigen::Vector3f> harmonic;  ///< constant terms of the colours (f_dc)
  std::vector<float> opacity;             ///< logits
  std::vector<Eigen::Vector3f> log_scale; ///< natural logarithms of the axes [world units]; -infinity: flat
  std::vector<Eigen::Vector4f> rotation;  ///< quaternions w x y z of any length, which turn the axes into the world
};

} // namespace pointgi
