#pragma once
/// H(B) of all pairs of points on the device, each with a ray of its own (method.md section 4;
/// kernels/radiosity/direct/receive_from_all.cl): exact and quadratic, what the fast multipole method is measured by.
#include "fmm/operators/point_pair.h"
#include "fmm/solve/radiosity_operator.h"
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "host/passes/device_pools.h"
#include "host/radiosity/occupancy.h"
#include "shared/pair_types.h"
#include <functional>
#include <optional>

namespace pointgi {

struct DirectOptions {
  float step_delta = 0.0f;            ///< root cube units, of the absolute-delta variant only
  std::uint64_t memory_bytes = 0;     ///< what all bits may take; 0: what the device has left
  std::uint64_t allocation_bytes = 0; ///< what one piece of them may take; 0: what the device gives in one
  /// Where they do not fit.
  std::string remedy = "use radiosity.method = \"directions\" or \"fmm\", a coarser spacing, or another --device";
  bool keep = true; ///< the bits; else each apply traces all pairs anew, in as much memory as a few rows take
  /// 2: without reciprocity each end asks for itself. Both trace the ray from the lower index to the higher, so that
  /// the answers are the same: what reciprocity saves can be measured.
  unsigned rays_a_pair = 1;
  const Occupancy* occupancy = nullptr;       ///< visibility by marching through it; null: by rays
  std::function<void(double share)> progress; ///< of the rays, [0, 1], after every launch; may be empty
};

/// Bytes of the kept bits: one an unordered pair, in squares of 256 x 256 points: 8192 s (s + 1) / 2 with
/// s = ceil(points / 256) (kernels/shared/pair_types.h). About points² / 16.
std::uint64_t direct_bytes(std::size_t points);

/// Traces the visibility of all pairs and keeps it on the device, a bit a pair, which both of its ends read; or traces
/// it at each apply. A receiver's sources are summed in their own order by one work-item: the same bits whatever is
/// kept, and whatever the threads and the launches.
class DeviceDirect : public RadiosityOperator {
public:
  /// `points`: those that exchange light, near ones close to each other in their order. `pools` are those of `variant`
  /// and hold all that blocks. `session` and `pools` must outlive this. Throws Error(memory) where the bits do not fit,
  /// Error(device).
  DeviceDirect(Session& session, const DevicePools& pools, const TraversalVariant& variant, View<Splat> points,
               const DirectOptions& options);

  std::size_t points() const override { return points_.size(); }
  /// Linear in B whatever the linearisation point is.
  void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) override;

  std::uint64_t rays() const { return rays_; }
  std::uint64_t kept_bytes() const;                       ///< of bits, as allocated; 0 where they are traced anew
  double trace_seconds() const { return trace_seconds_; } ///< of the device
  double apply_seconds() const { return apply_seconds_; } ///< of the device, of all applies

private:
  /// The tiles of the rows [first, end), in one piece of memory.
  struct Band {
    Buffer<cl_ulong> tiles;
    cl_uint first = 0, end = 0;
  };

  void check_memory(const DirectOptions& options) const;
  /// Of at most so many bytes each, but of a row of squares at least.
  void make_bands(std::uint64_t bytes);
  void allocate(Band& band);
  void trace(const Band& band);
  /// Calls launch(column, columns, row, rows), which returns the device's seconds, for windows that cover the tiles of
  /// the band.
  template <class Launch>
  void in_windows(const Band& band, const Launch& launch);
  PairRows launch_of(const Band& band, cl_uint row, cl_uint rows, cl_uint column, cl_uint columns) const;
  /// Adds what rows receive by the pairs of the band: its own from the columns up to its end, rows before it from its
  /// points. Band after band, from the first on.
  void receive(const Band& band, const Buffer<cl_float>& flux);

  Session& session_;
  DevicePools pools_;
  std::vector<ExchangePoint> points_;
  cl_uint tiles_ = 0; ///< a row: blocks of FMM_LANES points
  cl_uint stride_ = 0;
  std::vector<Band> bands_;
  bool keep_;
  unsigned rays_a_pair_;
  std::optional<Occupancy> occupancy_;
  std::size_t group_; ///< work-items a tile
  float step_delta_;
  Buffer<cl_float> point_buffer_, irradiance_;
  Buffer<Splat> table_;
  Buffer<cl_uint> ray_count_;
  cl::Kernel pairs_, receive_;
  Pace trace_pace_{2e4};   ///< tiles
  Pace receive_pace_{1.0}; ///< tiles
  std::function<void(double)> progress_;
  double tiles_done_ = 0.0;
  std::uint64_t rays_ = 0;
  double trace_seconds_ = 0.0, apply_seconds_ = 0.0;
};

} // namespace pointgi
