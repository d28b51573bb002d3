#pragma once
/// H(B) by what each point sees in a set of directions (method.md section 8; kernels/radiosity/directions): rays grow
/// as the points, whatever stands between them.
#include "fmm/solve/radiosity_operator.h"
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "host/passes/device_pools.h"
#include "host/radiosity/direction_set.h"
#include "host/scene/lighting.h"
#include "octree/splat.h"
#include <functional>

namespace pointgi {

struct DirectionsOptions {
  DirectionPattern pattern = DirectionPattern::stratified;
  unsigned directions = 64; ///< a point
  unsigned seed = 1;
  float step_delta = 0.0f;                    ///< root cube units, of the absolute-delta variant only
  std::uint64_t memory_bytes = 0;             ///< what kept hits may take, 4 bytes a ray; 0: bytes_for_hits()
  std::function<void(double share)> progress; ///< of the rays that are kept, [0, 1], after every launch; may be empty
};

/// Bytes that hits may take of those that a device has `left`: three quarters, less what an apply sends and receives,
/// the rest being for later stages; less 350 for each point of the pool, which is what a run may come to on host and
/// device besides. Of a pool so large that nothing is left then, 24 a point, by which the device holds 150 in all.
std::uint64_t bytes_for_hits(std::uint64_t left, std::size_t pool);

/// Traces the directions of all points and keeps the hits, as many as fit; those of the other points are traced again
/// at each apply. The same bits either way, and for any launches: what a point sees depends on it and the seed alone.
class DeviceDirections : public RadiosityOperator {
public:
  /// `places`: of the points that exchange light, ascending, in the pool, whose points are `pool`. `pools` are those
  /// of `variant` and hold all that blocks. With grouping packet, direction k of BEAM_RAYS
  /// points is traced as one beam, but through patches and for hemicubes (directions_in_beams). `session`, `pools`,
  /// `pool` and `places` must outlive this. Throws Error(device), Error(memory); std::invalid_argument where places do
  /// not ascend.
  DeviceDirections(Session& session, const DevicePools& pools, const TraversalVariant& variant, View<Splat> pool,
                   View<std::uint32_t> places, const DirectionsOptions& options);

  std::size_t points() const override { return places_.size; }
  /// Linear in B whatever the linearisation point is.
  void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) override;

  /// [points x 3, in the order of `places`, W/m² divided by the lighting's scale]: irradiance from the environment, of
  /// a map by its smooth_sky, which must be there.
  std::vector<float> sky(const DeviceLighting& lighting);

  /// [points, in the order of `places`, root cube units]: the harmonic mean of the lengths of each one's rays; infinity
  /// where they meet nothing.
  std::vector<float> mean_ways();
  /// Whether no point is traced again at each apply.
  bool keeps_all() const { return kept_ == places_.size; }

  unsigned directions() const { return static_cast<unsigned>(set_.weights.size()); } ///< a point
  std::uint64_t rays() const { return rays_; }            ///< with those that were traced again
  std::uint64_t beam_rays() const { return beam_rays_; }  ///< of them, first hits that beams have found
  std::uint64_t kept_bytes() const;                       ///< of hits: 4 a ray, of points in whole blocks of BEAM_RAYS
  double trace_seconds() const { return trace_seconds_; } ///< of the device

private:
  /// The hits of the points [first, end), as they are traced.
  struct Band {
    Buffer<cl_uint> hits;
    cl_uint first = 0, end = 0;
  };

  void keep_bands(const DirectionsOptions& options);
  /// progress: of the band's points.
  void trace(const Band& band, const std::function<void(double)>& progress);
  Buffer<cl_float4> upload_normals();
  Buffer<cl_float4> upload_radiosity(View<double> radiosity);
  void receive(const Band& band, const Buffer<cl_float4>& radiosity);
  /// Of all points, in bands: those that are kept, and then the others, traced again.
  void for_each_band(const std::function<void(const Band&)>& use);
  /// take(index into `places`, value) of what the device has found, in pieces.
  template <class T, class Take>
  void for_each_piece(const Buffer<T>& found, const Take& take);

  Session& session_;
  DevicePools pools_;
  DirectionSet set_;
  View<Splat> pool_;
  bool hemicube_;
  cl_uint points_an_item_; ///< of the trace
  std::size_t group_;
  cl_uint seed_;
  float step_delta_;
  View<std::uint32_t> places_;       ///< as given
  std::vector<std::uint32_t> order_; ///< index into `places_` of each that is traced, in their order: blocks of beams
  std::vector<Band> bands_;          ///< kept: from the first point on
  cl_uint kept_ = 0, at_once_ = 0;   ///< points of all of these; of a band that is not
  Buffer<cl_uint> place_buffer_, ray_count_;
  Buffer<std::array<float, 4>> cells_;
  Buffer<float> weights_, ways_;
  Buffer<cl_float4> irradiance_;
  cl::Kernel trace_, receive_;
  Pace trace_pace_, receive_pace_; ///< work-items, points
  std::uint64_t rays_ = 0, beam_rays_ = 0;
  double trace_seconds_ = 0.0;
};

} // namespace pointgi
