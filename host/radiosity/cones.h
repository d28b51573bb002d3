#pragma once
/// H(B) by cones through a pyramid of voxels on the device (docs/method/cones.md; kernels/radiosity/cones).
#include "fmm/solve/radiosity_operator.h"
#include "host/passes/device_cones.h"
#include "host/radiosity/voxel_pyramid.h"

namespace pointgi {

/// Cones about the normal z that cover the hemisphere, in rings of 1, 1 + 5, 3 + 6 or 1 + 5 + 10: angles to the normal
/// and shares are a quadrature of cosine-weighted directions, and a cone has the solid angle of its ring's part. Throws
/// std::invalid_argument for a number that is not among limits::cone_counts.
std::vector<Cone> cone_set(unsigned count);

/// Injects B, averages it upwards, and traces the cones of every point that exchanges light. Linear in B.
class ConeExchange : public RadiosityOperator {
public:
  /// `points`: all that block light; `places`: of them, those that exchange it, in the order of apply(). `session` must
  /// outlive this. Throws as VoxelPyramid and cone_set.
  ConeExchange(Session& session, View<Splat> points, View<std::uint32_t> places, const VoxelOptions& options,
               unsigned cones);

  std::size_t points() const override { return places_.size(); }
  void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) override;

  /// The voxels with this light, for as long as nothing else is injected. `radiosity` [points that block x 4, W/m²].
  DeviceCones with_light(View<cl_float4> radiosity);

  const VoxelPyramid& pyramid() const { return pyramid_; }
  double trace_seconds() const { return trace_seconds_; } ///< of the device, of all applies

private:
  Session& session_;
  VoxelPyramid pyramid_;
  std::vector<std::uint32_t> places_;
  Buffer<cl_uint> place_buffer_;
  Buffer<ConeGrid> grid_;
  Buffer<Cone> cones_;
  Buffer<cl_float> irradiance_;
  cl::Kernel trace_;
  Pace pace_;
  double trace_seconds_ = 0.0;
};

} // namespace pointgi
