#pragma once
/// Embree over the same splats: the peer of bench_traversal. Threads as OpenMP has them.
#include "octree/splat.h"
#include "shared/traversal_types.h"
#include <embree3/rtcore.h>
#include <vector>

namespace pointgi::bench {

class EmbreePeer {
public:
  /// Builds a high-quality BVH over oriented discs; build_seconds() tells how long that took.
  explicit EmbreePeer(const std::vector<Splat>& splats);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  double build_seconds() const { return build_seconds_; }

  /// Seconds for the nearest hits of all rays: one at a time, and in packets of 16 neighbouring rays.
  double closest_single(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const;
  double closest_packet16(const std::vector<RayQuery>& rays, std::vector<RayAnswer>& answers) const;
  /// Seconds to learn of all rays whether they hit anything.
  double any_single(const std::vector<RayQuery>& rays) const;

private:
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  double build_seconds_ = 0.0;
};

} // namespace pointgi::bench
