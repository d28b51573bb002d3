#pragma once
/// What is known of a pair of clusters from their bounds alone, for all of their points at once (method.md §3).
#include "octree/vmap/cluster_tree.h"

namespace pointgi {

enum class Facing {
  none, ///< no point of the one lies before any point of the other
  some, ///< not known to be either
  all   ///< all lie before all
};

/// How the points of `b` lie as the points of `a` see them: n_a.(b-a) over the pair, bounded by the support of b's box
/// along a's axis less a's own extent along it, widened by a's cone. `none` forgets what lies before a point by less
/// than rounding, so that a flat wall does not see itself.
Facing facing(const Cluster& a, const Cluster& b);

/// Whether radius_a + radius_b < separation * distance of the centres.
bool well_separated(const Cluster& a, const Cluster& b, float separation);

/// E = max(A_a, A_b) cos cos / (pi D²): what share of its radiosity one may send to a point of the other, at most. The
/// cosines are bounded over the pair, D is the distance of the centres.
float exchange_bound(const Cluster& a, const Cluster& b);

} // namespace pointgi
