#include "fmm/operators/grids.h"
#include "fmm/operators/chebyshev.h"
#include "octree/parallel.h"
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace pointgi {

namespace {

/// A side shorter than this share of the longest is widened to it: on flat clusters the place across is then well
/// defined in float, too (2^-10 of a side leaves 13 bits of it).
constexpr double least_share = 1.0 / 1024.0;
/// And this much of the root cube, for clusters of one point: a hundred steps of a float in [0, 1).
constexpr double least_side = 1e-5;

/// Nodes that a side of `share` times the longest needs. Interpolation's error falls like ratio^n, ratio = half a side
/// over the distance; of pairs just separated (radii below 0.55 of the distance together) the longest side's ratio is
/// about 0.3, a side of `share` has 0.3 share.
unsigned nodes_of_side(unsigned order, double share) {
  const double ratio = std::log(0.3);
  const double needed = order * ratio / (ratio + std::log(share));
  // A single node would be the value in the middle: only where the side is nothing.
  const unsigned least = share < 1.5 * least_share ? 1 : 2;
  return std::clamp(static_cast<unsigned>(std::ceil(needed - 1e-9)), std::min(least, order), order);
}

void set_box(const ClusterTree& tree, std::size_t k, std::vector<Grid>& grids) {
  const Cluster& cluster = tree.nodes[k];
  Grid& grid = grids[k];
  double low[3], high[3], longest = least_side;
  for (int a = 0; a < 3; ++a) {
    low[a] = cluster.low[a], high[a] = cluster.high[a];
    for (std::uint32_t c = cluster.first_child; c < cluster.first_child + cluster.child_count; ++c) {
      low[a] = std::min(low[a], grids[c].centre[a] - grids[c].half_side[a]);
      high[a] = std::max(high[a], grids[c].centre[a] + grids[c].half_side[a]);
    }
    longest = std::max(longest, high[a] - low[a]);
  }
  for (int a = 0; a < 3; ++a) {
    grid.centre[a] = 0.5 * (low[a] + high[a]);
    grid.half_side[a] = 0.5 * std::max(high[a] - low[a], least_share * longest);
  }
}

void set_counts(Grid& grid, const GridOptions& options) {
  const double longest = std::max({grid.half_side[0], grid.half_side[1], grid.half_side[2]});
  grid.count = 1;
  for (int a = 0; a < 3; ++a) {
    grid.axis[a] = options.fewer_across ? nodes_of_side(options.order, grid.half_side[a] / longest) : options.order;
    grid.count *= grid.axis[a];
  }
}

void place_nodes(const Grid& grid, std::uint32_t padded, std::vector<double>* position) {
  for (std::uint32_t k = 0; k < padded; ++k) {
    const std::uint32_t m = std::min(k, grid.count - 1);
    const unsigned index[3] = {m % grid.axis[0], m / grid.axis[0] % grid.axis[1], m / grid.axis[0] / grid.axis[1]};
    for (int a = 0; a < 3; ++a)
      position[a][grid.first + k] = grid.centre[a] + grid.half_side[a] * chebyshev_node(grid.axis[a], index[a]);
  }
}

} // namespace

std::uint32_t node_behind(std::uint32_t first, std::uint32_t count) {
  const std::uint64_t end = std::uint64_t{first} + (std::uint64_t{count} + FMM_LANES - 1) / FMM_LANES * FMM_LANES;
  if (end > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error(
        "the far field's grids have more nodes than 32 bits count; use a lower order or fewer points");
  return static_cast<std::uint32_t>(end);
}

Grids make_grids(const ClusterTree& tree, const GridOptions& options) {
  if (options.order < 2 || options.order > FMM_MAX_ORDER)
    throw std::invalid_argument("order of the far field: " + std::to_string(options.order) + ", not 2 to 6");
  Grids grids;
  grids.of.resize(tree.nodes.size());
  for (std::size_t k = tree.nodes.size(); k-- > 0;) // children stand behind their parents
    set_box(tree, k, grids.of);
  std::uint32_t first = 0;
  for (Grid& grid : grids.of) {
    set_counts(grid, options);
    grid.first = first;
    first = node_behind(first, grid.count);
  }
  for (auto& position : grids.position)
    position.resize(first);
  parallel_ranges(grids.of.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      place_nodes(grids.of[k], (k + 1 < grids.of.size() ? grids.of[k + 1].first : first) - grids.of[k].first,
                  grids.position);
  });
  return grids;
}

void grid_weights(const Grid& grid, const double x[3], double weights[3][FMM_MAX_ORDER]) {
  for (int a = 0; a < 3; ++a)
    chebyshev_weights(grid.axis[a], (x[a] - grid.centre[a]) / grid.half_side[a], weights[a]);
}

} // namespace pointgi
