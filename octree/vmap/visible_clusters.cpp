#include "octree/vmap/visible_clusters.h"
#include <algorithm>
#include <stdexcept>

namespace pointgi {

VisibleClusters::VisibleClusters(const ClusterTree& tree, View<Link> links)
    : tree_(tree), links_(links), first_(tree.nodes.size() + 1) {
  for (const Link& l : links) {
    if (std::max(l.a, l.b) >= tree.nodes.size())
      throw std::invalid_argument("vmap: a link names a cluster that the tree does not have");
    ++first_[l.a + 1];
    if (l.b != l.a) ++first_[l.b + 1];
  }
  for (std::size_t n = 1; n < first_.size(); ++n)
    first_[n] += first_[n - 1];
  ends_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < links.size; ++k) {
    const Link& l = links[k];
    const auto index = static_cast<std::uint32_t>(k);
    ends_[next[l.a]++] = {l.b, index, l.visible, l.kind};
    if (l.b != l.a) ends_[next[l.b]++] = {l.a, index, l.visible, l.kind};
  }
}

std::vector<std::uint32_t> VisibleClusters::visible_from(std::uint32_t cluster) const {
  std::vector<std::uint32_t> found;
  const auto take = [&](std::uint32_t node) {
    for (const ClusterLink& l : of(node))
      found.push_back(l.other);
  };
  for (std::uint32_t node = cluster; node != 0;) {
    node = tree_.nodes[node].parent;
    take(node);
  }
  std::vector<std::uint32_t> below{cluster};
  while (!below.empty()) {
    const Cluster& c = tree_.nodes[below.back()];
    take(below.back());
    below.pop_back();
    for (std::uint32_t k = 0; k < c.child_count; ++k)
      below.push_back(c.first_child + k);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::uint32_t VisibleClusters::link_between(std::uint32_t point, std::uint32_t other) const {
  for (std::uint32_t node = tree_.leaf_of[point];; node = tree_.nodes[node].parent) {
    for (const ClusterLink& l : of(node)) {
      const Cluster& c = tree_.nodes[l.other];
      if (other >= c.first_point && other < c.first_point + c.count) return l.link;
    }
    if (node == 0) return 0xffffffffu;
  }
}

Sight VisibleClusters::sight(std::uint32_t point, std::uint32_t other) const {
  const std::uint32_t link = link_between(point, other);
  if (link == 0xffffffffu) return Sight::blocked;
  return links_[link].visible == 1.0f ? Sight::open : Sight::partly;
}

} // namespace pointgi
