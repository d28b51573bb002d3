#pragma once
/// How far what the links say lies from the visibility of every pair of points.
#include "octree/vmap/make_links.h"

namespace pointgi {

struct LinkQuality {
  double error = 0.0;             ///< relative L2 of H over the receivers
  double bias = 0.0;              ///< (sum of H by links) / (sum of H) - 1
  double hiding = 0.0;            ///< share, in light, of what goes through links of share 1 and is blocked
  double missing = 0.0;           ///< share, in light, of what goes through no link and is not blocked
  std::size_t complete = 0;       ///< links of share 1 that the receivers met
  std::size_t wrong_complete = 0; ///< of these, links that hide more than `tolerated` of their facing pairs
};

/// The irradiance H [n of `receivers`] by the links, far as the sum over points without clamps, mid as one flux
/// vector, near with clamps, each times its share or the receiver's own of `point_shares`, then far as mid (method.md
/// §3, §4), against the same sum with each pair's own
/// visibility. `radiosity`: one a point, tree order. Points nearer than the sum of their radii count as visible in
/// both. O(receivers * n), each pair traced: for small scenes.
LinkQuality link_quality(const ClusterTree& tree, const VMap& map, VisibilityOracle& oracle, View<double> radiosity,
                         View<std::uint32_t> receivers, double tolerated);

} // namespace pointgi
