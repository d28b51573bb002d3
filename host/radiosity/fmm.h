#pragma once
/// H(B) by the fast multipole method on the device (method.md section 4; kernels/radiosity/fmm).
#include "fmm/operators/fmm_operator.h"
#include "host/cl/batches.h"
#include "host/cl/session.h"

namespace pointgi {

/// As FmmOperator, in float on the device. A row of a list is summed in its own order by one work-item, so an apply
/// gives the same bits whatever the number of threads and the size of launches.
class DeviceFmm : public RadiosityOperator {
public:
  /// Uploads points, grids and lists, and builds the kernels. `session` and `tree` must outlive it. Throws
  /// std::invalid_argument as FmmOperator does, Error(device) or Error(memory) as Session does.
  DeviceFmm(Session& session, const ClusterTree& tree, View<Link> links, const FmmOptions& options,
            View<std::uint8_t> point_shares = {});

  std::size_t points() const override { return points_.size(); }
  void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) override;

  double device_seconds() const { return device_seconds_; } ///< of all applies
  const Grids& grids() const { return grids_; }
  const InteractionLists& lists() const { return lists_; }

private:
  static constexpr double first_pairs = 2e7; ///< of a first launch, of which nothing is known yet

  /// Work-items that run one after another in launches of about the same time.
  struct Jobs {
    Buffer<cl_uint4> items;
    std::vector<double> cost; ///< of the jobs before this one, in pairs; one more than there are jobs
    Pace pace{first_pairs};   ///< pairs
  };
  struct Rows {
    Buffer<cl_uint> begin, source;
    Buffer<cl_float> share;
    Buffer<cl_uint> own_share;
  };

  Jobs make_jobs(const std::vector<cl_uint4>& items, const std::vector<double>& costs);
  void make_node_jobs();
  void make_point_jobs();
  Rows upload(const SourceLists& lists);
  /// Calls launch(shape, first, count) for pieces of all jobs; `launch` returns the device's seconds.
  template <class Launch>
  void in_pieces(Jobs& jobs, const Launch& launch);

  Session& session_;
  const ClusterTree& tree_;
  Grids grids_;
  InteractionLists lists_;
  std::vector<ExchangePoint> points_;
  FluxSides sides_;
  std::vector<ClusterFlux> fluxes_;
  cl_uint nodes_ = 0, stride_ = 0; ///< nodes of all grids; points padded to blocks
  std::size_t group_ = 8;
  bool has_linearisation_ = false;
  double device_seconds_ = 0.0;

  std::vector<Jobs> up_, down_; ///< a level each; leaves apart from other clusters in up_
  Jobs leaves_, far_;           ///< blocks of nodes, as those above
  Jobs interpolate_, read_;     ///< blocks of points
  Rows far_rows_, mid_rows_, near_rows_;
  Buffer<cl_uchar> point_shares_;
  Buffer<cl_uint> flux_begin_;
  Buffer<FmmCluster> cluster_buffer_;
  Buffer<FmmGrid> grid_buffer_;
  Buffer<cl_float> node_buffer_, point_buffer_;
  Buffer<cl_float> moments_, local_, irradiance_;
  cl::Kernel p2m_, m2m_, m2l_, l2l_, l2p_, receive_points_;
};

} // namespace pointgi
