#pragma once
/// The V-map: which clusters see each other, and how light goes between them (method.md §3).
#include "octree/vmap/cluster_tree.h"
#include "shared/fmm_types.h"

namespace pointgi {

enum class LinkKind : std::uint8_t {
  far,  ///< well separated and wholly facing: expansions (M2L); partly visible, as mid
  mid,  ///< little light, facing mixed: the source as a flux vector a side, both clamps at each receiver
  near_ ///< leaf pairs: points with points, clamped
};

constexpr std::uint32_t no_point_shares = NO_POINT_SHARES;

/// An unordered pair of clusters (a <= b; a == b: a leaf with itself, near). No link: nothing is visible.
struct Link {
  std::uint32_t a = 0, b = 0;
  float visible = 1.0f; ///< share of the segments between the two that nothing blocks, in (0, 1]
  LinkKind kind = LinkKind::near_;
  /// Where the shares that each point sees of the other cluster begin (octree/vmap/point_shares.h): one a point of a,
  /// then one a point of b; or no_point_shares: `visible` holds for all of them.
  std::uint32_t point_shares = no_point_shares;
  /// While links are made: nothing is known that could hide points of the one from points of the other, and none asks.
  bool open = false;
};

} // namespace pointgi
