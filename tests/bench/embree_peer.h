#pragma once
/// Embree over the same splats: the peer of bench_traversal. Threads as OpenMP has them.
#include "octree/splat.h"
#include "shared/traversal_types.h"
#include <cstddef>
#include <embree3/rtcore.h>
#include <vector>

namespace pointgi::bench {

class EmbreePeer {
public:
  /// Builds a high-quality BVH over oriented discs.
  explicit EmbreePeer(const std::vector<Splat>& splats);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// Finds the nearest hits of all rays: one at a time, in streams of 32, in packets of 16 neighbouring rays.
  void closest_single(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const;
  void closest_stream32(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const;
  void closest_packet16(const std::vector<RayPacketQuery>& packets, std::vector<RayPacketAnswer>& answers) const;
  /// Learns of all rays whether they hit anything; returns how many do. In streams and packets a tail of fewer rays is
  /// left out.
  std::size_t any_single(const std::vector<RayQuery>& rays) const;
  std::size_t any_stream32(const std::vector<RayQuery>& rays) const;
  std::size_t any_packet16(const std::vector<RayQuery>& rays) const;

private:
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

} // namespace pointgi::bench
