#include "host/photon/specular_leaves.h"
#include "octree/vmap/cluster_tree.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

/// Of a sphere about the cluster's centre that holds its discs, a little to spare for rounding.
float radius_of(const ClusterTree& tree, const Cluster& c) {
  double radius = 0.0;
  for (std::uint32_t k = c.first_point; k < c.first_point + c.count; ++k) {
    double distance2 = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double off = double{tree.points[k].position[a]} - double{c.centre[a]};
      distance2 += off * off;
    }
    radius = std::max(radius, std::sqrt(distance2) + double{tree.points[k].radius});
  }
  return static_cast<float>(radius * (1.0 + 1e-5) + 1e-6);
}

/// Photons are aimed at spheres, and those that pass their splats by are lost: the squares of the radii tell how many.
/// A cluster is divided where its parts' squares add up to little more than its own: a flat mirror down to where the
/// discs' rims tell, as smaller leaves are better told hidden or seen; a ball, and any body that its parts' spheres
/// would cover several times, is left whole.
constexpr double worth_dividing = 1.3;

class Cut {
public:
  Cut(const ClusterTree& tree, bool all_small) : tree_(tree), radius_(tree.nodes.size()), divided_(tree.nodes.size()) {
    std::vector<double> squares(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) { // children stand behind their parents
      const Cluster& c = tree.nodes[i];
      radius_[i] = radius_of(tree, c);
      double sum = 0.0;
      for (std::uint32_t k = 0; k < c.child_count; ++k)
        sum += squares[c.first_child + k];
      const double own = double{radius_[i]} * double{radius_[i]};
      divided_[i] = c.child_count > 0 && (all_small || sum <= worth_dividing * own);
      squares[i] = divided_[i] ? sum : own;
    }
  }

  float radius(std::uint32_t node) const { return radius_[node]; }

  /// The clusters that are left whole, or those above them so that there are at most `most`, in the order of their
  /// points.
  std::vector<std::uint32_t> nodes(std::size_t most) const {
    std::vector<std::uint32_t> level{0};
    for (bool deeper = true; deeper;) {
      deeper = false;
      std::vector<std::uint32_t> next;
      for (const std::uint32_t node : level) {
        const Cluster& c = tree_.nodes[node];
        if (!divided_[node]) next.push_back(node);
        for (std::uint32_t k = 0; k < c.child_count && divided_[node]; ++k)
          next.push_back(c.first_child + k);
        deeper |= divided_[node];
      }
      if (next.size() > most) break;
      level = std::move(next);
    }
    std::sort(level.begin(), level.end(), [&](std::uint32_t a, std::uint32_t b) {
      return tree_.nodes[a].first_point < tree_.nodes[b].first_point;
    });
    return level;
  }

private:
  const ClusterTree& tree_;
  std::vector<float> radius_;
  std::vector<bool> divided_;
};

} // namespace

SpecularLeaves specular_leaves(View<Splat> points, const std::function<bool(const Splat&)>& specular, std::size_t most,
                               bool all_small) {
  SpecularLeaves result;
  result.leaf_of.assign(points.size, NO_PHOTON_LEAF);
  std::vector<Splat> chosen;
  std::vector<std::uint32_t> of;
  for (std::size_t i = 0; i < points.size; ++i)
    if (specular(points[i])) {
      chosen.push_back(points[i]);
      of.push_back(static_cast<std::uint32_t>(i));
    }
  if (chosen.empty()) return result;
  const ClusterTree tree = build_clusters(chosen, {});
  for (const std::uint32_t k : tree.order)
    result.splats.push_back(of[k]);
  const Cut cut(tree, all_small);
  for (const std::uint32_t node : cut.nodes(std::max<std::size_t>(1, most))) {
    const Cluster& c = tree.nodes[node];
    PhotonLeaf leaf{};
    std::copy_n(c.centre, 3, leaf.centre);
    leaf.radius = cut.radius(node);
    leaf.first = c.first_point;
    leaf.count = c.count;
    for (std::uint32_t k = c.first_point; k < c.first_point + c.count; ++k)
      result.leaf_of[result.splats[k]] = static_cast<std::uint32_t>(result.leaves.size());
    result.leaves.push_back(leaf);
    result.axis.insert(result.axis.end(), c.axis, c.axis + 3);
    result.area.push_back(c.area);
  }
  return result;
}

} // namespace pointgi
