#pragma once
/// Progressive refinement radiosity (method.md section 8): in each pass every receiver gathers from senders, a ray a
/// pair; of the senders it may take all, or one of each window of neighbours.
#include "host/radiosity/direct.h"
#include "host/radiosity/sender_windows.h"

namespace pointgi {

enum class GatherSampling {
  all,         ///< every sender
  fixed,       ///< of each window the same sender, which sends for all of it
  monte_carlo, ///< of each window one at random, for each receiver and in each pass another
  mipmap,      ///< of each window the mean
  adaptive     ///< the means of a cut through the octree, which is refined pass by pass where radiosity differs
};

struct GatherOptions {
  GatherSampling sampling = GatherSampling::all;
  unsigned window = 128;        ///< points of a window, at most; adaptive: senders are refined to points / window
  bool reciprocity = true;      ///< one ray a pair for both directions, else one for each; of `all` only
  bool visibility_cache = true; ///< what is visible is kept for later passes; not of monte_carlo, nor of adaptive
  const Occupancy* occupancy = nullptr; ///< visibility by marching through it; null: by rays
  unsigned seed = 1;
  float step_delta = 0.0f;                    ///< root cube units, of the absolute-delta variant only
  std::uint64_t memory_bytes = 0;             ///< what the cache may take; 0: what the device has left
  std::uint64_t allocation_bytes = 0;         ///< what one piece of it may take; 0: what the device gives in one
  std::function<void(double share)> progress; ///< of a pass, [0, 1], after every launch that traces; may be empty
};

/// Bytes of the visibility cache: of all senders a bit an unordered pair, direct_bytes(points). Of others a bit a
/// receiver and sender, ceil(points / 8) `senders`, a sender a window.
std::uint64_t gather_cache_bytes(GatherSampling sampling, std::size_t points, std::size_t senders);

class DeviceGather {
public:
  /// `pools` are those of `variant` and hold all that blocks. `session`, `pools`, `tree` must outlive this. Throws
  /// std::invalid_argument on options that do not go together, Error(memory) where the cache does not fit,
  /// Error(device).
  DeviceGather(Session& session, const DevicePools& pools, const TraversalVariant& variant, const ClusterTree& tree,
               const GatherOptions& options);

  /// H(B) [points x 3] of radiosity [points x 3], tree order, as pass number `pass` takes its senders. The same bits
  /// for the same pass, whatever was gathered before; adaptive sampling refines where B differs.
  void gather(View<double> radiosity, unsigned pass, std::vector<double>& irradiance);

  std::size_t points() const { return tree_.points.size(); }
  std::size_t senders() const; ///< that a receiver asks in a pass
  bool is_refined() const;     ///< adaptive: to as many as it may have; true of all others
  std::uint64_t rays() const;  ///< or marches
  std::uint64_t cache_bytes() const;

private:
  /// Rows of blocks of receivers, whose bits are in one piece of memory.
  struct Band {
    Buffer<cl_uchar> seen;
    cl_uint first = 0, end = 0;
    bool traced = false;
  };

  void take_senders(Senders&& senders);
  void take_cut(const ClusterCut& cut);
  void make_bands();
  SenderRows launch_of(const Band& band, std::size_t first, std::size_t rows, unsigned pass) const;
  void trace(Band& band, unsigned pass);
  void receive(const Band& band, unsigned pass, const Buffer<cl_float>& flux);

  Session& session_;
  DevicePools pools_;
  const ClusterTree& tree_;
  GatherOptions options_;
  std::optional<Occupancy> occupancy_;
  std::unique_ptr<DeviceDirect> pairs_; ///< of `all`, which it does alone
  SenderWindows windows_;
  ClusterCut first_cut_, cut_; ///< adaptive: of the first pass, and of this one
  Senders senders_;            ///< not of monte_carlo
  std::vector<ExchangePoint> points_;
  cl_uint rows_ = 0, stride_ = 0, sender_stride_ = 0, sender_count_ = 0;
  std::size_t group_;
  std::vector<Band> bands_;
  Buffer<Splat> table_, seen_;
  Buffer<cl_uint> members_, ray_count_;
  Buffer<SenderWindow> device_windows_;
  Buffer<cl_float> point_planes_, sender_planes_, irradiance_;
  cl::Kernel trace_, receive_;
  Pace trace_pace_{64.0}, receive_pace_{64.0}; ///< rows
  std::uint64_t rays_ = 0;
};

} // namespace pointgi
