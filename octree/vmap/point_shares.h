#pragma once
/// What each point sees of the clusters that are partly hidden from it.
#include "octree/vmap/make_links.h"

namespace pointgi {

struct PointShareOptions {
  /// A point asks one segment of each link, at near leaves every pair; where the former are more than this on average,
  /// up to four neighbours share one.
  unsigned samples = 32;
  std::uint32_t seed = 1;       ///< of the choice of points
  std::size_t batch = 1u << 22; ///< segments asked at a time, about: bounds the memory, changes nothing else
};

/// A share for every point at either end of every link that is partly visible, in 1/255, and Link::point_shares where
/// they begin. One share for a whole pair of clusters would cut shadows into blocks: it jumps where the next cluster
/// begins, and its error is the same for all points of the pair; with shares of their own neighbours differ only by
/// what they see, and the errors of many links cancel. Segments end where most light comes from (PairSamples::towards);
/// of near leaves, which may touch, every pair of points is asked and counts as much as it exchanges. The same for any
/// number of threads and any batch. `rays`: counts the segments asked for. Throws
/// std::invalid_argument on options out of range, std::length_error when the shares pass 4 GiB, and what the oracle
/// throws.
std::vector<std::uint8_t> make_point_shares(const ClusterTree& tree, std::vector<Link>& links, VisibilityOracle& oracle,
                                            const PointShareOptions& options, std::uint64_t& rays);

} // namespace pointgi
