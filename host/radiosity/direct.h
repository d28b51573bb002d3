#pragma once
/// H(B) of all pairs of points on the device, each with a ray of its own (method.md section 4;
/// kernels/radiosity/direct/receive_from_all.cl): exact and quadratic, what the fast multipole method is measured by.
#include "fmm/operators/point_pair.h"
#include "fmm/solve/radiosity_operator.h"
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "host/passes/device_pools.h"
#include <functional>

namespace pointgi {

struct DirectOptions {
  float step_delta = 0.0f;                    ///< root cube units, of the absolute-delta variant only
  std::uint64_t memory_bytes = 0;             ///< what all bits may take; 0: what the device has left
  std::uint64_t allocation_bytes = 0;         ///< what one piece of them may take; 0: what the device gives in one
  std::function<void(double share)> progress; ///< of the rays, [0, 1], after every launch; may be empty
};

/// Traces the visibility of all pairs once and keeps it on the device, a bit a pair in both directions. A receiver's
/// sources are summed in their own order by one work-item: the same bits whatever the threads and the launches.
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
  double trace_seconds() const { return trace_seconds_; } ///< of the device
  double apply_seconds() const { return apply_seconds_; } ///< of the device, of all applies

private:
  /// Rows of tiles in one piece of memory, [first, end).
  struct VisibilityRows {
    Buffer<cl_uchar> bits;
    cl_uint first = 0, end = 0;
  };

  void make_bands(const DirectOptions& options);
  void trace(const DevicePools& pools, const TraversalVariant& variant, View<Splat> points,
             const DirectOptions& options);
  /// Calls launch(column, columns, row, rows), which returns the device's seconds, for windows that cover the tiles on
  /// and below the diagonal. `group`: work-items a tile.
  template <class Launch>
  void in_windows(const VisibilityRows& of_rows, const VisibilityRows& of_columns, std::size_t group, Pace& pace,
                  const Launch& launch);

  Session& session_;
  std::vector<ExchangePoint> points_;
  cl_uint tiles_ = 0; ///< a row: blocks of FMM_LANES points
  cl_uint stride_ = 0;
  std::vector<VisibilityRows> bands_;
  Buffer<cl_float> point_buffer_, irradiance_;
  cl::Kernel receive_;
  Pace rows_{1.0}; ///< rows of receive_from_all
  std::uint64_t rays_ = 0;
  double trace_seconds_ = 0.0, apply_seconds_ = 0.0;
};

} // namespace pointgi
