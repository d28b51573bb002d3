#pragma once
/// What may stand between two clusters, from bounds alone (Haines and Wallace, "Shaft culling for efficient ray-traced
/// radiosity", 1991): the hull of both clusters' boxes, less what lies behind either's points, against boxes around
/// all splats.
#include "octree/vmap/cluster_tree.h"
#include <functional>

namespace pointgi {

enum class Obstacles {
  none, ///< every point of the one sees every point of the other that it faces
  own,  ///< discs that may belong to the surfaces at the two ends, as those of a bent surface do; or it is not known
  some  ///< something may hide points of the one from points of the other
};

/// Boxes around splats, by their clusters: of flat faces these are flat, and the face that a cluster lies on falls away
/// early. For any number of questions at once.
class Shafts {
public:
  /// `splats`: all that block.
  explicit Shafts(View<Splat> splats);

  /// `own` as well where the question takes too long.
  Obstacles between(const Cluster& a, const Cluster& b) const;

  /// The clusters of all splats, as leaves() and discs_from() see them; in another order than `splats`
  /// (ClusterTree::order).
  const ClusterTree& tree() const { return tree_; }

  /// Node k with the box around its discs instead of their centres, and all that a place on one of them may look over.
  Cluster with_discs(std::uint32_t k) const;
  /// The same of one point alone, in the tree's order.
  Cluster disc(std::uint32_t point) const;

  /// Calls look(point) for the points whose leaf reaches into the box, in the tree's order, until it returns false;
  /// false then.
  bool for_each_near(const float low[3], const float high[3], const std::function<bool(std::uint32_t)>& look) const;

  /// Whether no ray from a place on the discs of `from` to a place of `light` meets anything but discs that belong to
  /// the surfaces at its ends (kernels/surface/own_surface.cl). `from`: with_discs() or disc(); only of one disc it is
  /// known which others belong to it. `light`: of discs, too, or, not `has_surface`, a box in space. False where the
  /// question takes too long.
  bool is_open(const Cluster& from, const Cluster& light, bool has_surface) const;

private:
  struct Box {
    float low[3], high[3];
  };
  static Box box_of(const Splat& disc);
  /// Calls meets(splat) for the splats whose boxes the shaft meets until it returns false. False then, or where that
  /// takes too long.
  template <class Shaft, class Meets>
  bool for_each_met(const Shaft& shaft, const Meets& meets) const;

  ClusterTree tree_;
  std::vector<Box> boxes_; ///< around the discs of each node
};

} // namespace pointgi
