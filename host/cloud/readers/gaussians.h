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

/// A Gaussian whose shortest axis is longer than this share of the middle one has no flat side, thus no normal.
constexpr float flat_gaussian = 0.8f;
/// Radius of the disc over the geometric mean of the two longer axes: the disc pi r^2 has the area that the Gaussian
/// has as the integral of its profile, 2 pi s t. With it and least_opacity the discs of a clean capture leave less than
/// 1 % of its opaque pixels open and cover 3 to 9 % more beside them; a factor of 1 leaves 2 to 4 % open, one of 2
/// covers 9 to 20 % more.
constexpr float gaussian_radius = 1.41421356f;

/// Fills colour, opacity, radius and normal of the cloud; radii and normals (other than zero) that the cloud has
/// already are kept.
/// colour = 0.5 + 0.28209479 f_dc, clamped to [0,1]; opacity = 1 / (1 + exp(-logit)), which complete_cloud() drops by;
/// normal = the shortest axis, of either sign (`normals_unsigned` is set), zero where there is none.
/// Values that are not finite are passed on: complete_cloud() drops and counts their points.
/// `report`: notes of what was made of them and how many are too faint.
void discs_from_gaussians(const GaussianValues& gaussians, PointCloud& cloud, CloudReport& report);

} // namespace pointgi
