#include "octree/pack/step_pools.h"
#include <limits>
#include <stdexcept>

namespace pointgi {

namespace {

/// Leaves are met in the order of the curve, so that the Begin-End pool's next entry closes the one before.
void pack_node(const Tree& tree, std::uint32_t index, StepPools& pools) {
  const TreeNode& node = tree.nodes[index];
  OctreeNode& packed = pools.nodes[index];
  if (node.first_child != 0) {
    packed = {NODE_HEADER(NODE_INTERNAL, node.level), node.first_child, node.first_point, node.count};
    const std::uint32_t children = 1u << (3 * tree.options.axis_bits);
    for (std::uint32_t c = 0; c < children; ++c)
      pack_node(tree, node.first_child + c, pools);
    return;
  }
  if (node.count + node.extra_count == 0) {
    packed = {NODE_HEADER(NODE_EMPTY, node.level), 0, 0, 0};
    return;
  }
  packed = {NODE_HEADER(NODE_LEAF, node.level), static_cast<std::uint32_t>(pools.begin_end.size()), node.extra_count,
            node.count};
  pools.begin_end.push_back(node.first_point);
  const auto extra = tree.extra.begin() + node.first_extra;
  pools.begin_end.insert(pools.begin_end.end(), extra, extra + node.extra_count);
  ++pools.leaves;
}

} // namespace

StepPools pack_step(View<Splat> splats, const Tree& tree) {
  if (tree.extra.size() + tree.nodes.size() >= std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("octree: the Begin-End pool outgrows 32-bit addresses; raise the leaf capacity");
  StepPools pools;
  pools.axis_bits = tree.options.axis_bits;
  pools.depth = tree.depth;
  pools.extra_splats = tree.extra.size();
  pools.source = tree.order;
  pools.points.reserve(splats.size);
  for (std::uint32_t input : tree.order)
    pools.points.push_back(splats[input]);
  pools.nodes.resize(tree.nodes.size());
  pools.begin_end.reserve(tree.extra.size() + tree.nodes.size());
  pack_node(tree, 0, pools);
  pools.begin_end.push_back(static_cast<std::uint32_t>(splats.size));
  pools.begin_end.shrink_to_fit();
  return pools;
}

} // namespace pointgi
