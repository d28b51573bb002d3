#include "octree/ref/link_quality.h"
#include "octree/parallel.h"
#include "octree/vmap/pair_samples.h"
#include "octree/vmap/visible_clusters.h"
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

using Vector = Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;
constexpr std::uint32_t no_link = 0xffffffffu;

Vector vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// cos cos / (pi |r|^4) |r|^2 of two points, the cosines as they are: negative behind.
struct Kernel {
  double value = 0.0;
  bool facing = false;
};

Kernel kernel_of(const Splat& x, const Splat& y) {
  const Vector r = vector_of(y.position) - vector_of(x.position);
  const double at_x = vector_of(x.normal).dot(r), at_y = -vector_of(y.normal).dot(r), d2 = r.squaredNorm();
  if (d2 == 0.0) return {};
  return {at_x * at_y / (pi * d2 * d2), face_each_other(x, y)};
}

/// One receiver's share of the sums.
struct Receiver {
  double exact = 0.0, by_links = 0.0, hiding = 0.0, missing = 0.0;
};

/// Of one link, over the receivers under it.
struct Tally {
  std::uint32_t facing = 0, blocked = 0;
};

class Quality {
public:
  Quality(const ClusterTree& tree, const VMap& map, View<double> radiosity)
      : tree_(tree), links_(map.links), shares_(map.point_shares), radiosity_(radiosity), visible_(tree, links_),
        tally_(links_.size), flux_(tree.nodes.size(), Vector::Zero()), place_(tree.nodes.size(), Vector::Zero()) {
    parallel_ranges(tree.nodes.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        sum_flux(n);
    });
  }

  Receiver receive(std::uint32_t i, VisibilityOracle& oracle) {
    const std::size_t n = tree_.points.size();
    std::vector<std::uint32_t> link_to(n, no_link);
    Receiver sum;
    for (std::uint32_t node = tree_.leaf_of[i];; node = tree_.nodes[node].parent) {
      for (const ClusterLink& l : visible_.of(node))
        sum.by_links += follow(i, node, l, link_to);
      if (node == 0) break;
    }
    const std::vector<std::uint8_t> blocked = trace(i, oracle);
    for (std::size_t j = 0; j < n; ++j)
      compare(i, j, blocked[j] != 0, link_to[j], sum);
    return sum;
  }

  const std::vector<Tally>& tally() const { return tally_; }

private:
  void sum_flux(std::size_t n) {
    const Cluster& c = tree_.nodes[n];
    double weight = 0.0;
    for (std::uint32_t k = c.first_point; k < c.first_point + c.count; ++k) {
      const double power = radiosity_[k] * static_cast<double>(tree_.points[k].area);
      flux_[n] += power * vector_of(tree_.points[k].normal);
      place_[n] += power * vector_of(tree_.points[k].position);
      weight += power;
    }
    if (weight > 0.0) place_[n] /= weight;
  }

  /// What comes to point i through the link.
  double follow(std::uint32_t i, std::uint32_t node, const ClusterLink& l, std::vector<std::uint32_t>& link_to) const {
    const Cluster& source = tree_.nodes[l.other];
    const Splat& x = tree_.points[i];
    const bool own = links_[l.link].point_shares != no_point_shares;
    const LinkKind kind = own && l.kind == LinkKind::far ? LinkKind::mid : l.kind;
    double sum = 0.0;
    for (std::uint32_t j = source.first_point; j < source.first_point + source.count; ++j) {
      link_to[j] = l.link;
      const Kernel k = kernel_of(x, tree_.points[j]);
      if (kind == LinkKind::far || (kind == LinkKind::near_ && k.facing && j != i))
        sum += k.value * radiosity_[j] * static_cast<double>(tree_.points[j].area);
    }
    if (kind == LinkKind::mid) {
      const Vector r = place_[l.other] - vector_of(x.position);
      const double d2 = r.squaredNorm();
      sum = std::max(0.0, vector_of(x.normal).dot(r)) * std::max(0.0, -flux_[l.other].dot(r)) / (pi * d2 * d2);
    }
    return (own ? own_share(i, node, links_[l.link]) : static_cast<double>(l.visible)) * sum;
  }

  /// Point i of the cluster `node` at one end of the link.
  double own_share(std::uint32_t i, std::uint32_t node, const Link& link) const {
    const std::size_t skipped = node == link.a ? 0 : tree_.nodes[link.a].count;
    return shares_[link.point_shares + skipped + (i - tree_.nodes[node].first_point)] / 255.0;
  }

  /// Whether each point that faces point i is hidden from it.
  std::vector<std::uint8_t> trace(std::uint32_t i, VisibilityOracle& oracle) const {
    std::vector<Segment> segments;
    std::vector<std::uint8_t> blocked(tree_.points.size());
    const Splat& x = tree_.points[i];
    for (std::uint32_t j = 0; j < tree_.points.size(); ++j) {
      const Splat& y = tree_.points[j];
      const double touching = static_cast<double>(x.radius) + y.radius;
      const bool near = (vector_of(y.position) - vector_of(x.position)).squaredNorm() < touching * touching;
      if (j != i && !near && face_each_other(x, y)) segments.push_back({i, j});
    }
    const std::vector<std::uint8_t> answers = oracle.blocked(segments);
    for (std::size_t s = 0; s < segments.size(); ++s)
      blocked[segments[s].to] = answers[s];
    return blocked;
  }

  void compare(std::uint32_t i, std::size_t j, bool blocked, std::uint32_t link, Receiver& sum) {
    const Kernel k = kernel_of(tree_.points[i], tree_.points[j]);
    if (j == i || !k.facing) return;
    const double light = k.value * radiosity_[j] * static_cast<double>(tree_.points[j].area);
    if (!blocked) sum.exact += light;
    if (!blocked && link == no_link) sum.missing += light;
    if (link == no_link) return;
    if (blocked && links_[link].visible == 1.0f) sum.hiding += light;
    ++tally_[link].facing;
    tally_[link].blocked += blocked;
  }

  const ClusterTree& tree_;
  View<Link> links_;
  View<std::uint8_t> shares_;
  View<double> radiosity_;
  VisibleClusters visible_;
  std::vector<Tally> tally_;
  std::vector<Vector> flux_, place_; ///< of each node: sum of B A n, and its centroid weighted by B A
};

} // namespace

LinkQuality link_quality(const ClusterTree& tree, const VMap& map, VisibilityOracle& oracle, View<double> radiosity,
                         View<std::uint32_t> receivers, double tolerated) {
  const View<Link> links = map.links;
  Quality quality(tree, map, radiosity);
  LinkQuality result;
  double difference2 = 0.0, exact2 = 0.0, exact = 0.0, by_links = 0.0;
  for (const std::uint32_t i : receivers) {
    const Receiver r = quality.receive(i, oracle);
    difference2 += (r.by_links - r.exact) * (r.by_links - r.exact);
    exact2 += r.exact * r.exact;
    exact += r.exact;
    by_links += r.by_links;
    result.hiding += r.hiding;
    result.missing += r.missing;
  }
  result.error = std::sqrt(difference2 / exact2);
  result.bias = by_links / exact - 1.0;
  result.hiding /= exact;
  result.missing /= exact;
  for (std::size_t l = 0; l < links.size; ++l) {
    const auto& [facing, blocked] = quality.tally()[l];
    if (facing == 0 || links[l].visible != 1.0f) continue;
    ++result.complete;
    result.wrong_complete += static_cast<double>(blocked) > tolerated * facing;
  }
  return result;
}

} // namespace pointgi
