#pragma once
/// Where the expansions of each cluster have their nodes.
#include "octree/vmap/cluster_tree.h"
#include "shared/fmm_types.h"

namespace pointgi {

/// The Chebyshev grid of a cluster: a box that holds its points and its children's boxes, so that nothing is ever
/// extrapolated. Lengths in root cube units.
struct Grid {
  double centre[3], half_side[3]; ///< half_side > 0
  unsigned axis[3];               ///< nodes along each axis
  std::uint32_t count;            ///< all nodes: axis[0] axis[1] axis[2]
  std::uint32_t first;            ///< of its nodes in Grids::x, a multiple of FMM_LANES
};

struct Grids {
  std::vector<Grid> of;            ///< one a cluster
  std::vector<double> position[3]; ///< of each node, axis by axis; padding repeats a grid's last node
  std::size_t nodes() const { return position[0].size(); }
};

struct GridOptions {
  unsigned order = 3; ///< nodes along the longest side, 2..FMM_MAX_ORDER
  /// Shorter sides have only as many nodes as the same error asks: a wall needs n x n x 1. false: order along all.
  bool fewer_across = true;
};

/// The first node behind a grid of `count` nodes that begins with node `first`, padded to blocks. Throws
/// std::length_error where 32 bits do not count it.
std::uint32_t node_behind(std::uint32_t first, std::uint32_t count);

/// Throws std::invalid_argument on an order out of range, std::length_error as node_behind().
Grids make_grids(const ClusterTree& tree, const GridOptions& options);

/// Interpolation weights of the point `x` in `grid`, axis after axis, FMM_MAX_ORDER apart.
void grid_weights(const Grid& grid, const double x[3], double weights[3][FMM_MAX_ORDER]);

} // namespace pointgi
