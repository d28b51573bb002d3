#pragma once
/// The links as each receiver reads them.
#include "fmm/operators/grids.h"
#include "octree/vmap/links.h"

namespace pointgi {

/// Rows of (source cluster, visible share), one row a receiving cluster, in the order of the links.
struct SourceLists {
  std::vector<std::uint32_t> begin; ///< row k is [begin[k], begin[k + 1]); one more than there are clusters
  std::vector<std::uint32_t> source;
  std::vector<float> share;
  std::vector<std::uint32_t> own_share; ///< where those of the receiver's points begin, or no_point_shares
};

/// Both directions of every link. Far links whose points have shares of their own are mid, their sources divided until
/// they are small as seen from the receiver. A point reads the near and mid rows of its leaf and of all clusters above
/// it.
struct InteractionLists {
  SourceLists far, mid, near_;
};

/// What one apply of the operator evaluates.
struct ExchangeCounts {
  std::uint64_t m2l = 0; ///< pairs of clusters, each direction one, by expansions
  std::uint64_t m2p = 0; ///< points with flux vectors of clusters
  std::uint64_t p2p = 0; ///< points with points
};

struct ListOptions {
  /// A far link of fewer than this many pairs of points for each pair of nodes goes as point pairs, which is then
  /// cheaper and exact. 0: only where its splats are so close that they are more than points (FMM_CLOSE).
  double direct_below = 1.5;
};

/// `point_shares`: how many there are for links to refer to. Throws std::invalid_argument on a link to a cluster that
/// is not there, of a cluster with itself unless it is a near leaf, with a share outside (0, 1], or whose points'
/// shares are not there; std::length_error on more than 2^31 links or 2^32 entries.
InteractionLists make_interaction_lists(const ClusterTree& tree, View<Link> links, std::size_t point_shares,
                                        const Grids& grids, const ListOptions& options);

ExchangeCounts count_exchanges(const ClusterTree& tree, const InteractionLists& lists);

} // namespace pointgi
