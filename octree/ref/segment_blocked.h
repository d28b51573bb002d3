#pragma once
/// Brute-force truth of visibility: a segment between two points against every splat.
#include "octree/vmap/make_links.h"

namespace pointgi {

/// Whether a disc stands between the centres of two splats, besides those of the surfaces at its ends (OcclusionEnds of
/// kernels/lib/ray.cl), in double precision. O(n).
bool segment_blocked(View<Splat> splats, const Splat& from, const Splat& to);

/// Asks segment_blocked, on all cores.
class LinearScan : public VisibilityOracle {
public:
  /// `points`: what segments run between, in the tree's order; `splats`: what blocks. Both must outlive this.
  LinearScan(View<Splat> points, View<Splat> splats) : points_(points), splats_(splats) {}
  std::vector<std::uint8_t> blocked(View<Segment> segments) override;

private:
  View<Splat> points_, splats_;
};

} // namespace pointgi
