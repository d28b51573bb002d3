#include "fmm/lists/interaction_lists.h"
#include "fmm/operators/cluster_flux.h"
#include "octree/parallel.h"
#include <algorithm>
#include <stdexcept>
#include <string>

namespace pointgi {

namespace {

void check(const ClusterTree& tree, const Link& link, std::size_t point_shares) {
  const auto refuse = [&](const char* why) {
    throw std::invalid_argument("link of clusters " + std::to_string(link.a) + " and " + std::to_string(link.b) + ": " +
                                why);
  };
  if (link.a >= tree.nodes.size() || link.b >= tree.nodes.size()) refuse("no such cluster");
  if (link.a == link.b && (link.kind != LinkKind::near_ || tree.nodes[link.a].child_count != 0))
    refuse("only a leaf is linked to itself, and near");
  if (!(link.visible > 0.0f && link.visible <= 1.0f)) refuse("its visible share is not in (0, 1]");
  if (link.point_shares != no_point_shares &&
      std::size_t{link.point_shares} + tree.nodes[link.a].count + tree.nodes[link.b].count > point_shares)
    refuse("the shares of its points are not there");
}

/// Radius of a source of a mid row over its distance, at most, where it can be divided.
constexpr float widest_flux = 0.15f;

/// Area of the largest splat of each cluster.
std::vector<float> largest_areas(const ClusterTree& tree) {
  std::vector<float> largest(tree.nodes.size(), 0.0f);
  for (std::size_t k = tree.nodes.size(); k-- > 0;) {
    const Cluster& c = tree.nodes[k];
    if (c.child_count == 0)
      for (std::uint32_t i = c.first_point; i < c.first_point + c.count; ++i)
        largest[k] = std::max(largest[k], tree.points[i].area);
    if (k != 0) largest[c.parent] = std::max(largest[c.parent], largest[k]);
  }
  return largest;
}

/// Distance of the boxes, squared.
float gap_squared(const Cluster& a, const Cluster& b) {
  float sum = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float gap = std::max({0.0f, a.low[axis] - b.high[axis], b.low[axis] - a.high[axis]});
    sum += gap * gap;
  }
  return sum;
}

/// Calls use(cluster) for a source's parts that are small as they look from the receiver. A flux in the middle of a
/// source is too bright by the square of its angle: 1.3 % of what partly hidden links carry in a room when they are
/// taken whole.
template <class Use>
void for_small_parts(const ClusterTree& tree, std::uint32_t source, const Cluster& receiver, const Use& use) {
  const Cluster& c = tree.nodes[source];
  float distance2 = 0.0f;
  for (int axis = 0; axis < 3; ++axis)
    distance2 += (c.centre[axis] - receiver.centre[axis]) * (c.centre[axis] - receiver.centre[axis]);
  if (c.child_count == 0 || c.radius * c.radius < widest_flux * widest_flux * distance2) {
    use(source);
    return;
  }
  for (std::uint32_t k = 0; k < c.child_count; ++k)
    for_small_parts(tree, c.first_child + k, receiver, use);
}

SourceLists rows_of(const ClusterTree& tree, View<Link> links, const std::vector<LinkKind>& kinds, LinkKind kind) {
  const std::size_t clusters = tree.nodes.size();
  SourceLists lists;
  lists.begin.assign(clusters + 1, 0);
  // Of links that are mid because they are faint the error is as faint.
  const auto for_sources = [&](const Link& link, std::uint32_t receiver, std::uint32_t source, const auto& use) {
    if (kind == LinkKind::mid && link.kind == LinkKind::far)
      for_small_parts(tree, source, tree.nodes[receiver], use);
    else
      use(source);
  };
  std::uint64_t entries = 0;
  const auto count = [&](const Link& link, std::uint32_t receiver, std::uint32_t source) {
    for_sources(link, receiver, source, [&](std::uint32_t) {
      ++lists.begin[receiver + 1];
      ++entries;
    });
  };
  for (std::size_t k = 0; k < links.size; ++k)
    if (kinds[k] == kind) {
      count(links[k], links[k].a, links[k].b);
      if (links[k].a != links[k].b) count(links[k], links[k].b, links[k].a);
    }
  if (entries > 0xffffffffu)
    throw std::length_error("radiosity: more than 2^32 entries of a list; a larger radiosity.epsilon has less");
  for (std::size_t k = 0; k < clusters; ++k)
    lists.begin[k + 1] += lists.begin[k];
  lists.source.resize(lists.begin.back());
  lists.share.resize(lists.begin.back());
  lists.own_share.resize(lists.begin.back());
  std::vector<std::uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  const auto add = [&](std::uint32_t receiver, std::uint32_t source, const Link& link) {
    const bool own = link.point_shares != no_point_shares;
    const std::uint32_t skipped = receiver == link.a ? 0 : tree.nodes[link.a].count;
    for_sources(link, receiver, source, [&](std::uint32_t part) {
      lists.source[next[receiver]] = part;
      lists.share[next[receiver]] = link.visible;
      lists.own_share[next[receiver]++] = own ? link.point_shares + skipped : no_point_shares;
    });
  };
  for (std::size_t k = 0; k < links.size; ++k)
    if (kinds[k] == kind) {
      add(links[k].a, links[k].b, links[k]);
      if (links[k].a != links[k].b) add(links[k].b, links[k].a, links[k]);
    }
  return lists;
}

} // namespace

InteractionLists make_interaction_lists(const ClusterTree& tree, View<Link> links, std::size_t point_shares,
                                        const Grids& grids, const ListOptions& options) {
  if (links.size > 0x7fffffffu)
    throw std::length_error("radiosity: more than 2^31 links; a larger radiosity.epsilon has less");
  const std::vector<float> largest = largest_areas(tree);
  std::vector<LinkKind> kinds(links.size);
  parallel_ranges(links.size, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Link& link = links[k];
      check(tree, link, point_shares);
      kinds[k] = link.kind;
      if (link.kind != LinkKind::far) continue;
      const Cluster &a = tree.nodes[link.a], &b = tree.nodes[link.b];
      const bool close = gap_squared(a, b) < FMM_CLOSE * std::max(largest[link.a], largest[link.b]);
      const double pairs = static_cast<double>(a.count) * b.count,
                   node_pairs = static_cast<double>(grids.of[link.a].count) * grids.of[link.b].count;
      if (close || pairs < options.direct_below * node_pairs)
        kinds[k] = LinkKind::near_;
      else if (link.point_shares != no_point_shares)
        kinds[k] = LinkKind::mid;
    }
  });
  return {rows_of(tree, links, kinds, LinkKind::far), rows_of(tree, links, kinds, LinkKind::mid),
          rows_of(tree, links, kinds, LinkKind::near_)};
}

ExchangeCounts count_exchanges(const ClusterTree& tree, const InteractionLists& lists) {
  ExchangeCounts counts;
  const FluxSides sides = flux_sides(tree);
  counts.m2l = lists.far.source.size();
  for (std::size_t k = 0; k < tree.nodes.size(); ++k) {
    const std::uint64_t receivers = tree.nodes[k].count;
    for (std::uint32_t e = lists.mid.begin[k]; e < lists.mid.begin[k + 1]; ++e)
      counts.m2p += receivers * (sides.begin[lists.mid.source[e] + 1] - sides.begin[lists.mid.source[e]]);
    for (std::uint32_t e = lists.near_.begin[k]; e < lists.near_.begin[k + 1]; ++e)
      counts.p2p += receivers * tree.nodes[lists.near_.source[e]].count;
  }
  return counts;
}

} // namespace pointgi
