#pragma once
/// The hierarchical V-map: which clusters exchange light, how, and through what share of free segments (method.md §3).
#include "octree/vmap/links.h"
#include "shared/traversal_types.h"

namespace pointgi {

/// A question: does anything stand between two points? Indices into ClusterTree::points; the device's own struct.
using Segment = SegmentQuery;

/// Who answers: the device (host/passes/visibility.h), or a linear scan (octree/ref/segment_blocked.h).
class VisibilityOracle {
public:
  virtual ~VisibilityOracle() = default;
  /// One byte a segment, in their order: 1 when something besides the surfaces at its two ends is in its way, else 0.
  virtual std::vector<std::uint8_t> blocked(View<Segment> segments) = 0;
};

struct LinkOptions {
  unsigned samples = 8;     ///< K: segments a pair of clusters, 1 to 1024; more, up to 16 K, where more light goes, and
                            ///< 4 times as many where all were blocked
  float epsilon = 1e-2f;    ///< a pair whose exchange_bound is smaller is taken as it is; 0: none is
  float separation = 0.55f; ///< far apart: radius_a + radius_b < separation * distance; (0, 1]
  std::uint32_t seed = 1;   ///< of the choice of points
  bool thesis = false; ///< one segment a pair, between the points nearest to the centroids, whatever `samples` says
  /// Each point asks one segment of each cluster that is partly hidden from it; where that is more than this, up to
  /// four neighbours share one (octree/vmap/point_shares.h). 0: one share for all points of a pair.
  unsigned point_samples = 128;
  /// Rays after which pairs that are far apart are no longer divided, but taken with the share that `samples` segments
  /// find, and dropped if all are blocked: the time of foliage, where nearly all pairs hide each other in part, would
  /// grow as the square of its points. Decided between waves, so that a wave may go beyond by what its pairs ask once;
  /// not of point_shares. 0: no bound.
  std::uint64_t most_rays = 0;
  std::size_t batch = 1u << 22; ///< segments asked at a time, about: bounds the memory, changes nothing else
};

struct LinkStatistics {
  std::uint64_t pairs_tested = 0;
  std::uint64_t far = 0, mid = 0, near_ = 0; ///< links
  std::uint64_t rays = 0;                    ///< segments asked for
  std::uint64_t waves = 0;                   ///< rounds of questions
  std::uint64_t coarse_waves = 0;            ///< of these, after LinkOptions::most_rays
};

struct VMap {
  std::vector<Link> links;                ///< wave after wave; no pair twice
  std::vector<std::uint8_t> point_shares; ///< in 1/255; where a link's begin: Link::point_shares
  LinkStatistics statistics;
};

/// Dual traversal from the pair (root, root), a wavefront of pairs at a time: the host classifies all pairs of a wave
/// by their bounds, `oracle` answers the segments of those that bounds do not decide, and what is partly visible or not
/// wholly facing goes, divided, into the next wave. Every two points that exchange light and see each other lie under
/// one link, save for what sampling misses. Segments run between points that face each other, stratified by area, and
/// depend on the pair and the seed alone: the same links for any number of threads and any batch. Throws
/// std::invalid_argument on options out of range, and what the oracle throws.
/// `obstacles`: all splats that block: where some of them are flat, pairs between which none can stand ask nothing, and
/// of the others every point asks. Empty: what all segments of a pair find free is taken as open.
VMap make_links(const ClusterTree& tree, VisibilityOracle& oracle, const LinkOptions& options,
                View<Splat> obstacles = {});

/// What make_links would ask and make, about.
struct LinkEstimate {
  double pairs = 0.0; ///< of clusters, that would be tested
  double links = 0.0;
  double rays = 0.0;    ///< those of point_shares among them
  double bytes = 0.0;   ///< of links and shares
  double seconds = 0.0; ///< as long as the sample's questions took by the clock: not deterministic
};

/// The same traversal of a sample: of each wave at most `pairs_a_wave` pairs are asked, drawn evenly, each of which
/// then stands for several. Unbiased but for the shares of near leaves, half of whose pairs of points are taken to face
/// each other. options.most_rays has no effect: what would be asked without it is told. Deterministic, as make_links,
/// but for the seconds.
LinkEstimate estimate_links(const ClusterTree& tree, VisibilityOracle& oracle, const LinkOptions& options,
                            View<Splat> obstacles = {}, std::size_t pairs_a_wave = 4000);

} // namespace pointgi
