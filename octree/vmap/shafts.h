#pragma once
/// What may stand between two clusters, from bounds alone (Haines and Wallace, "Shaft culling for efficient ray-traced
/// radiosity", 1991): the hull of both clusters' boxes, less what lies behind either's points, against boxes around
/// all splats.
#include "octree/vmap/cluster_tree.h"

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

private:
  struct Box {
    float low[3], high[3];
  };
  static Box box_of(const Splat& disc);

  ClusterTree tree_;
  std::vector<Box> boxes_; ///< around the discs of each node
};

} // namespace pointgi
