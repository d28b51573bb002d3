#include "host/cloud/readers/gaussians.h"
#include "host/cloud/drop_points.h"
#include "octree/parallel.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t grain = 16384;

void colours_from_harmonics(const std::vector<Eigen::Vector3f>& harmonic, std::vector<Eigen::Vector3f>& colour) {
  constexpr float band_0 = 0.28209479f; // the constant spherical harmonic, 1 / (2 sqrt(pi))
  colour.resize(harmonic.size());
  parallel_ranges(harmonic.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < 3; ++k)
        colour[i][k] = std::clamp(0.5f + band_0 * harmonic[i][k], 0.0f, 1.0f); // NaN stays NaN
  });
}

void opacities_from_logits(const std::vector<float>& logit, std::vector<float>& opacity) {
  opacity.resize(logit.size());
  parallel_ranges(logit.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      opacity[i] = 1.0f / (1.0f + std::exp(-logit[i]));
  });
}

/// Indices of the axes, shortest first.
std::array<int, 3> axes_by_length(const Eigen::Vector3f& log_scale) {
  std::array<int, 3> axis{0, 1, 2};
  const auto order = [&](int a, int b) {
    if (log_scale[axis[b]] < log_scale[axis[a]]) std::swap(axis[a], axis[b]);
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return axis;
}

/// The axis of a turned frame, or zero where the quaternion tells none.
Eigen::Vector3f turned_axis(const Eigen::Vector4f& rotation, int axis) {
  const float length = rotation.stableNorm();
  if (!std::isnormal(length)) return Eigen::Vector3f::Zero();
  const Eigen::Vector4f q = rotation / length;
  return Eigen::Quaternionf(q[0], q[1], q[2], q[3]).toRotationMatrix().col(axis);
}

bool missing(const Eigen::Vector3f& normal) {
  return !(normal.allFinite() && std::isnormal(normal.stableNorm()));
}

} // namespace

void discs_from_gaussians(const GaussianValues& gaussians, PointCloud& cloud, CloudReport& report) {
  const std::size_t n = cloud.size();
  if (!gaussians.harmonic.empty()) colours_from_harmonics(gaussians.harmonic, cloud.colour);
  if (!gaussians.opacity.empty()) opacities_from_logits(gaussians.opacity, cloud.opacity);
  if (!gaussians.log_scale.empty()) {
    const bool with_radius = cloud.radius.empty();
    const bool with_normal = !gaussians.rotation.empty();
    if (with_radius) cloud.radius.resize(n);
    if (with_normal && cloud.normal.empty()) cloud.normal.assign(n, Eigen::Vector3f::Zero());
    cloud.normals_unsigned = with_normal;
    parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3f& scale = gaussians.log_scale[i];
        const std::array<int, 3> axis = axes_by_length(scale);
        if (with_radius) cloud.radius[i] = gaussian_radius * std::exp(0.5f * (scale[axis[1]] + scale[axis[2]]));
        if (!with_normal || !missing(cloud.normal[i])) continue;
        const bool flat = scale[axis[0]] - scale[axis[1]] <= std::log(flat_gaussian);
        cloud.normal[i] = flat ? turned_axis(gaussians.rotation[i], axis[0]) : Eigen::Vector3f::Zero();
      }
    });
  }

  const auto faint =
      std::count_if(cloud.opacity.begin(), cloud.opacity.end(), [](float opacity) { return opacity < least_opacity; });
  const auto round = std::count_if(cloud.normal.begin(), cloud.normal.end(), missing);
  if (!report.usual_up) report.usual_up = -Eigen::Vector3d::UnitY(); // as the cameras count that they were trained with
  report.notes.push_back("the file holds " + std::to_string(n) + " Gaussians, which are shown as discs; " +
                         std::to_string(faint) + " are nearly transparent (opacity below 0.1) and are left out, " +
                         std::to_string(round) + " are not flat and have no normal of their own.");
}

} // namespace pointgi
