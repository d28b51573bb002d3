#include "host/cloud/spanning_forest.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pointgi {

namespace {

constexpr unsigned graph_neighbours = 8;
constexpr std::uint32_t buckets = 4096; // edge weights are sorted by counting; the square root refines the sure ones
// Of leaving the surface against disagreeing. More keeps noisy sheets together (0.5 orients 99.9 % of a sphere whose
// noise is half its spacing, 0.35 99.8 %), less finds the back of a plate over its nearest pairs rather than askew at
// its rim.
constexpr double off_surface_weight = 0.35;
constexpr std::uint16_t no_edge = std::numeric_limits<std::uint16_t>::max();
constexpr double pi = 3.14159265358979323846;

/// The graph: slot [site * 8 + j] is the edge to the j-th neighbour; its key is 2 * bucket + (1 if the signs differ).
/// Where an edge leads, the sites are asked again: those of a cloud keep their neighbours.
struct Graph {
  const Sites& sites;
  std::vector<std::uint16_t> key;
  std::vector<float> reach2; ///< squared distance of the last neighbour

  std::uint32_t from(std::size_t slot) const { return static_cast<std::uint32_t>(slot / graph_neighbours); }
  std::uint32_t to(std::size_t slot) const {
    std::array<Neighbour, graph_neighbours> near;
    const auto number = static_cast<unsigned>(slot % graph_neighbours);
    sites.nearest(from(slot), number + 1, near.data());
    return near[number].site;
  }
};

std::uint16_t edge_key(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& e) {
  const double agreement = sign_agreement(a, b, e);
  // Edges that leave the surface (to another sheet, or into noise) are the last resort.
  const double off_surface = std::abs(a.dot(e) * b.dot(e)) / std::max(e.squaredNorm(), 1e-300);
  const double weight = std::min(0.5 * (1.0 - std::abs(agreement)) + off_surface_weight * off_surface, 1.0);
  const auto bucket = static_cast<std::uint32_t>(std::sqrt(weight) * (buckets - 1));
  return static_cast<std::uint16_t>(2 * bucket + (agreement < 0 ? 1 : 0));
}

Graph neighbour_graph(const Sites& sites, const std::vector<Eigen::Vector3f>& normals) {
  const std::size_t n = sites.size();
  Graph graph{sites, {}, {}};
  graph.key.assign(n * graph_neighbours, no_edge);
  graph.reach2.assign(n, 0.0f);
  parallel_ranges(n, 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, graph_neighbours> near;
    for (std::size_t s = begin; s < end; ++s) {
      const auto site = static_cast<std::uint32_t>(s);
      const unsigned count = sites.nearest(site, graph_neighbours, near.data());
      for (unsigned j = 0; j < count; ++j)
        graph.key[s * graph_neighbours + j] = edge_key(normals[s].cast<double>(), normals[near[j].site].cast<double>(),
                                                       sites.position(near[j].site) - sites.position(site));
      if (count > 0) graph.reach2[s] = near[count - 1].distance2;
    }
  });
  return graph;
}

/// Of an edge that both ends list, the end with the lower number keeps it: the other's slot becomes empty.
void drop_twins(Graph& graph) {
  parallel_ranges(graph.reach2.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, graph_neighbours> near, of_other;
    for (std::size_t s = begin; s < end; ++s) {
      const auto site = static_cast<std::uint32_t>(s);
      const unsigned count = graph.sites.nearest(site, graph_neighbours, near.data());
      for (unsigned j = 0; j < count; ++j) {
        const std::uint32_t other = near[j].site;
        if (site < other) continue;
        const unsigned others = graph.sites.nearest(other, graph_neighbours, of_other.data());
        const auto is_site = [&](const Neighbour& neighbour) { return neighbour.site == site; };
        if (std::any_of(of_other.begin(), of_other.begin() + others, is_site))
          graph.key[s * graph_neighbours + j] = no_edge;
      }
    }
  });
}

/// Slots that are not empty in the order of their weights, as numbers that count them all.
template <class Slot>
std::vector<Slot> edges_by_weight(const Graph& graph) {
  std::vector<std::uint64_t> start(buckets + 1, 0);
  for (const std::uint16_t key : graph.key)
    if (key != no_edge) ++start[key / 2u + 1];
  for (std::uint32_t b = 0; b < buckets; ++b)
    start[b + 1] += start[b];
  std::vector<Slot> order(start[buckets]);
  for (std::size_t slot = 0; slot < graph.key.size(); ++slot)
    if (graph.key[slot] != no_edge) order[start[graph.key[slot] / 2u]++] = static_cast<Slot>(slot);
  return order;
}

/// Union-find that also knows whether a site's normal must be flipped against that of its root: so the forest itself
/// need not be stored or walked.
class SignedSets {
public:
  explicit SignedSets(std::size_t n) : link_(n), size_(n, 1) {
    for (std::size_t i = 0; i < n; ++i)
      link_[i] = static_cast<std::uint32_t>(2 * i);
  }
  struct Root {
    std::uint32_t site;
    std::uint32_t flipped; ///< 0 or 1
  };
  Root find(std::uint32_t site) {
    std::uint32_t flipped = 0;
    while (parent(site) != site) {
      const std::uint32_t up = parent(site);
      link_[site] = 2 * parent(up) | ((link_[site] ^ link_[up]) & 1u); // halve the path; a root's own bit is 0
      flipped ^= link_[site] & 1u;
      site = parent(site);
    }
    return {site, flipped};
  }
  void join(std::uint32_t a, std::uint32_t b, std::uint32_t differ) {
    Root ra = find(a), rb = find(b);
    if (ra.site == rb.site) return;
    if (size_[ra.site] < size_[rb.site]) std::swap(ra, rb);
    size_[ra.site] += size_[rb.site];
    link_[rb.site] = 2 * ra.site | (ra.flipped ^ rb.flipped ^ differ);
  }

private:
  std::uint32_t parent(std::uint32_t site) const { return link_[site] >> 1; }
  std::vector<std::uint32_t> link_; ///< 2 * parent + 1 where the normal is opposite to the parent's
  std::vector<std::uint32_t> size_;
};

} // namespace

namespace {

template <class Slot>
void join_by_weight(const Graph& graph, SignedSets& sets) {
  for (const Slot slot : edges_by_weight<Slot>(graph))
    sets.join(graph.from(slot), graph.to(slot), graph.key[slot] & 1u);
}

} // namespace

SpanningForest agree_normals(const Sites& sites, std::vector<Eigen::Vector3f>& normals, std::uint64_t narrow_slots) {
  const std::uint32_t n = sites.size();
  SignedSets sets(n);
  SpanningForest forest;
  {
    Graph graph = neighbour_graph(sites, normals);
    drop_twins(graph);
    if (graph.key.size() <= narrow_slots)
      join_by_weight<std::uint32_t>(graph, sets);
    else
      join_by_weight<std::uint64_t>(graph, sets);
    forest.spacing2.resize(n);
    for (std::uint32_t s = 0; s < n; ++s)
      forest.spacing2[s] = graph.reach2[s] * static_cast<float>(pi / graph_neighbours);
  }
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(n, none);
  forest.tree.resize(n);
  for (std::uint32_t s = 0; s < n; ++s) {
    const SignedSets::Root root = sets.find(s);
    if (number[root.site] == none) number[root.site] = forest.trees++;
    forest.tree[s] = number[root.site];
    if (root.flipped != 0) normals[s] = -normals[s];
  }
  return forest;
}

} // namespace pointgi
