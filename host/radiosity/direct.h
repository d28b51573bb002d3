#pragma once
/// H(B) of all pairs of points on the device, each with a ray of its own (method.md section 4;
/// kernels/radiosity/direct/receive_from_all.cl): exact and quadratic, what the fast multipole method is measured by.
#include "fmm/operators/point_pair.h"
#include "fmm/solve/radiosity_operator.h"
#include "host/cl/batches.h"
#include "host/cl/session.h"
#include "host/passes/device_pools.h"
#include "host/radiosity/occupancy.h"
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
  const Occupancy* occupancy = nullptr;       ///< visibility by marching through it; null: by rays
  std::function<void(double share)> progress; ///< of the rays, [0, 1], after every launch; may be empty
};

/// Bytes of the kept bits: one in both directions of each pair, in blocks of FMM_LANES points.
std::uint64_t direct_bytes(std::size_t points);

/// Traces the visibility of all pairs once and keeps it on the device, a bit a pair in both directions; or traces it at
/// each apply. A receiver's sources are summed in their own order by one work-item: the same bits whatever is kept, and
/// whatever the threads and the launches.
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
  /// Tiles of rows and columns of blocks, in one piece of memory: rows [first, end), columns [first_column,
  /// end_column).
  struct Tiles {
    Buffer<cl_uchar> bits;
    cl_uint first = 0, end = 0, first_column = 0, end_column = 0;

    cl_uint row_bytes() const { return FMM_LANES * (end_column - first_column); }
    cl_uint4 place() const { return {{first, end_column - first_column, first_column, 0}}; }
  };

  void make_bands(const DirectOptions& options);
  Tiles allocate_tiles(cl_uint first, cl_uint end, cl_uint first_column, cl_uint end_column);
  /// Pairs of the rows [first, end) with the columns [first_column, end_column), on and below the diagonal; what lies
  /// above it goes to `of_columns` where `of_rows` does not hold it.
  void trace(const Tiles& of_rows, const Tiles& of_columns, cl_uint first_column, cl_uint end_column);
  /// Calls launch(column, columns, row, rows), which returns the device's seconds, for windows that cover the tiles on
  /// and below the diagonal.
  template <class Launch>
  void in_windows(cl_uint first_row, cl_uint end_row, cl_uint first_column, cl_uint end_column, const Launch& launch);
  /// Adds what the rows [first, end) receive from the columns of `tiles`.
  void receive(const Tiles& tiles, cl_uint first, cl_uint end, const Buffer<cl_float>& flux);
  void trace_and_receive(const Buffer<cl_float>& flux);

  Session& session_;
  DevicePools pools_;
  std::vector<ExchangePoint> points_;
  cl_uint tiles_ = 0; ///< a row: blocks of FMM_LANES points
  cl_uint stride_ = 0;
  std::vector<Tiles> bands_; ///< whole rows; empty where nothing is kept
  bool keep_;
  std::optional<Occupancy> occupancy_;
  std::size_t group_; ///< work-items a tile
  float step_delta_;
  Buffer<cl_float> point_buffer_, irradiance_;
  Buffer<Splat> table_;
  Buffer<cl_uint> ray_count_;
  cl::Kernel pairs_, receive_;
  Pace trace_pace_{2e4}; ///< tiles
  Pace rows_{1.0};       ///< rows of receive_from_all
  std::function<void(double)> progress_;
  double tiles_done_ = 0.0;
  std::uint64_t rays_ = 0;
  double trace_seconds_ = 0.0, apply_seconds_ = 0.0;
};

} // namespace pointgi
