#pragma once
/// The adaptive N^d octree over splats, before it is packed for a device form (octree/pack).
#include "octree/build/curve.h"
#include "octree/pool.h"
#include "octree/splat.h"
#include "octree/view.h"
#include <cstdint>
#include <vector>

namespace pointgi {

/// What a cell's leaf_capacity counts.
enum class Listing {
  overlaps, ///< own points and extra splats: the `step` form
  centres   ///< own points alone, no extra splats: the `wide` form, whose nodes know what their children really hold
};

struct TreeOptions {
  unsigned axis_bits = 1;      ///< log2 N: 1 (N = 2) or 2 (N = 4)
  unsigned leaf_capacity = 32; ///< a cell that lists no more splats than this, own and extra, is a leaf
  unsigned max_depth = 21;     ///< levels below the root; at most key_levels(axis_bits)
  Listing listing = Listing::overlaps;
  PointOrder order = PointOrder::morton; ///< of points, leaves and nodes in memory; which cells are divided is the same
};

/// A node of the tree. Children are stored together, in the order x + N*y + N*N*z.
struct TreeNode {
  std::uint32_t first_child = 0; ///< 0: a leaf (the root is nobody's child)
  std::uint32_t first_point = 0; ///< own points: [first_point, first_point + count) in tree order
  std::uint32_t count = 0;
  std::uint32_t first_extra = 0; ///< leaf: its extra splats in Tree::extra
  std::uint32_t extra_count = 0;
  std::uint32_t level = 0;
};

struct Tree {
  TreeOptions options;
  Pool<std::uint32_t> order;   ///< order[k]: input index of the k-th point along the curve
  std::vector<TreeNode> nodes; ///< nodes[0] is the root; the packers give them their order in memory
  Pool<std::uint32_t> extra;   ///< tree-order indices of extra splats, a leaf's together
  unsigned depth = 0;          ///< deepest level in use
};

/// Builds the tree over splats whose discs lie in the root cube. A splat belongs to the leaf of its centre and is also
/// listed, as an extra splat, in every other leaf that its disc touches (method.md §2). A cell is divided while it
/// lists more than leaf_capacity splats, is above max_depth, and dividing lowers the expected number of splats a ray
/// tests there. Works on all cores; the same tree for any number of them. Throws std::invalid_argument on options out
/// of range or more than 2^32-2 splats, std::length_error when the tree outgrows 32-bit addresses. `bends`: of the
/// splats, whose patches then count in place of their discs; empty: all are discs.
Tree build_tree(View<Splat> splats, const TreeOptions& options, View<PatchBend> bends = {});

} // namespace pointgi
