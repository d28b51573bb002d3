#pragma once
/// Questions to the V-map once it is made: what a cluster sees, and whether two points see each other.
#include "octree/vmap/links.h"

namespace pointgi {

/// A link as seen from one of its ends.
struct ClusterLink {
  std::uint32_t other = 0; ///< the cluster at the other end, or the cluster itself
  std::uint32_t link = 0;  ///< which link
  float visible = 1.0f;
  LinkKind kind = LinkKind::near_;
};

enum class Sight {
  blocked, ///< no link: nothing lets light from one to the other
  partly,  ///< a share of the segments between the clusters that hold them is free
  open     ///< every segment that was tried is free
};

/// The links sorted by cluster. Tree and links must outlive this.
class VisibleClusters {
public:
  /// Throws std::invalid_argument when a link names a cluster that the tree does not have.
  VisibleClusters(const ClusterTree& tree, View<Link> links);

  /// The links that end at this very cluster, in the order of the links. Light also reaches it through the links of the
  /// clusters above it, and parts of it through those of the clusters below.
  View<ClusterLink> of(std::uint32_t cluster) const {
    return {ends_.data() + first_[cluster], first_[cluster + 1] - first_[cluster]};
  }

  /// Every cluster that some point of `cluster` may see: the other ends of the links at it, above it and below it.
  /// Ascending, each once; some may hold others.
  std::vector<std::uint32_t> visible_from(std::uint32_t cluster) const;

  /// The link under which two points lie, indices in tree order; none: 0xffffffff. Goes through the links of the
  /// clusters that hold the first..
  std::uint32_t link_between(std::uint32_t point, std::uint32_t other) const;
  Sight sight(std::uint32_t point, std::uint32_t other) const;

private:
  const ClusterTree& tree_;
  View<Link> links_;
  std::vector<std::size_t> first_; ///< of each cluster's links, and one past the last
  std::vector<ClusterLink> ends_;
};

} // namespace pointgi
