#pragma once
/// Neighbours of many sites, one after the other, from what lies around the leaf that they share.
#include "host/cloud/site_tree.h"

namespace pointgi {

/// Finds what SiteTree::nearest(place, k, site, out) does, several times faster where sites are asked for in ascending
/// order: the tree is descended once a leaf, and the distances to all that lies around it are a loop without a branch.
/// What was asked for before changes the time that an answer takes, never the answer. Belongs to one thread.
class LeafSearch {
public:
  /// `k` is below the number of sites.
  unsigned nearest(const SiteTree& tree, std::uint32_t site, unsigned k, Neighbour* out);

private:
  static constexpr unsigned capacity = 2048; ///< candidates; more, and one search a site takes less time
  static constexpr unsigned few = 64;        ///< that are sorted by buckets
  static constexpr unsigned block = 16;      ///< candidates that are looked at together
  static constexpr unsigned room = capacity + SiteTree::leaf_size + block; ///< leaves and blocks are not cut

  void go_to_leaf_of(const SiteTree& tree, std::uint32_t site);
  unsigned search_tree(const SiteTree& tree, std::uint32_t site, unsigned k, Neighbour* out);
  void gather(const SiteTree& tree, float reach2);
  unsigned select(float limit2);
  void order_few(unsigned found, float limit2, unsigned k, Neighbour* out);
  void order_many(unsigned found, unsigned k, Neighbour* out);

  std::uint64_t tree_ = 0;            ///< SiteTree::id(); 0: none yet
  std::uint32_t last_site_ = 0;       ///< asked for before
  std::uint32_t begin_ = 0, end_ = 0; ///< sites of the leaf at hand; none when equal
  SiteTree::Box box_{};
  float reach2_ = 0.0f;     ///< all sites within are candidates; 0: none were gathered
  bool crowded_ = false;    ///< there are more than there is room for
  float last_reach_ = 0.0f; ///< squared distance of the k-th neighbour over k, of the site before; 0: not known
  float widest_ = 0.0f;     ///< the largest such value of the leaf
  unsigned candidates_ = 0;
  unsigned own_ = 0; ///< candidate that is the leaf's first site
  // Candidates in ascending order of their sites.
  std::array<float, room> x_, y_, z_, distance2_;
  std::array<std::uint32_t, room> site_, kept_;
};

} // namespace pointgi
