#include "octree/pack/wide_pools.h"
#include "octree/build/disc_cell.h"
#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace pointgi {

namespace {

struct Box {
  float low[3] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                  std::numeric_limits<float>::infinity()};
  float high[3] = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity()};

  void add(const Splat& splat) {
    float half[3];
    disc_half_extents(splat, half);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], splat.position[a] - half[a] - cell_margin);
      high[a] = std::max(high[a], splat.position[a] + half[a] + cell_margin);
    }
  }
  void add(const Box& other) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
};

struct Range {
  std::uint32_t first, count;
};

class Packer {
public:
  Packer(const Tree& tree, WidePools& pools) : tree_(tree), pools_(pools) {}

  void run() {
    pools_.nodes.emplace_back();
    const TreeNode& root = tree_.nodes[0];
    if (root.first_child != 0)
      fill_from_tree(0, root, 0);
    else
      fill_from_ranges(0, {{root.first_point, root.count}}, 0);
  }

private:
  std::uint32_t largest_leaf() const { return WIDE_MAX_BLOCKS * pools_.lanes; }

  static void set_child(WideNode& node, unsigned c, const Box& box, std::uint32_t reference) {
    // An empty child's box is inverted, and finite: infinities would turn into NaN where a ray runs along an axis.
    constexpr float far = 1e18f;
    for (int a = 0; a < 3; ++a) {
      node.low[a][c] = reference != 0 ? box.low[a] : far;
      node.high[a][c] = reference != 0 ? box.high[a] : -far;
    }
    node.child[c] = reference;
  }

  /// A node for what `contents(index)` fills in; returns its index.
  template <typename Fill>
  std::uint32_t new_node(Fill fill) {
    const auto index = static_cast<std::uint32_t>(pools_.nodes.size());
    pools_.nodes.emplace_back();
    fill(index);
    return index;
  }

  Box fill_from_tree(std::uint32_t index, const TreeNode& node, unsigned level) {
    Box all;
    for (unsigned c = 0; c < WIDE_CHILDREN; ++c) {
      const TreeNode& child = tree_.nodes[node.first_child + c];
      Box box;
      std::uint32_t reference = 0;
      if (child.first_child != 0)
        reference = new_node([&](std::uint32_t i) { box = fill_from_tree(i, child, level + 1); });
      else if (child.count > 0)
        reference = leaf_or_nodes({child.first_point, child.count}, level + 1, box);
      set_child(pools_.nodes[index], c, box, reference);
      all.add(box);
    }
    pools_.depth = std::max(pools_.depth, level + 1);
    return all;
  }

  Box fill_from_ranges(std::uint32_t index, const std::vector<Range>& ranges, unsigned level) {
    Box all;
    for (unsigned c = 0; c < WIDE_CHILDREN; ++c) {
      Box box;
      const bool used = c < ranges.size() && ranges[c].count > 0;
      const std::uint32_t reference = used ? leaf_or_nodes(ranges[c], level + 1, box) : 0;
      set_child(pools_.nodes[index], c, box, reference);
      all.add(box);
    }
    pools_.depth = std::max(pools_.depth, level + 1);
    return all;
  }

  std::uint32_t leaf_or_nodes(Range range, unsigned level, Box& box) {
    if (range.count <= largest_leaf()) return leaf(range, box);
    std::vector<Range> parts;
    const std::uint32_t part = (range.count + WIDE_CHILDREN - 1) / WIDE_CHILDREN;
    for (std::uint32_t at = 0; at < range.count; at += part)
      parts.push_back({range.first + at, std::min(part, range.count - at)});
    return new_node([&](std::uint32_t i) { box = fill_from_ranges(i, parts, level); });
  }

  std::uint32_t leaf(Range range, Box& box) {
    const unsigned lanes = pools_.lanes;
    const std::size_t first_block = pools_.block_count();
    const std::uint32_t blocks = (range.count + lanes - 1) / lanes;
    if (first_block + blocks > WIDE_BLOCK_MASK)
      throw std::length_error("octree: more leaf blocks than the wide form has addresses for; raise the leaf capacity");
    pools_.blocks.resize(pools_.blocks.size() + static_cast<std::size_t>(blocks) * WIDE_BLOCK_WORDS(lanes), 0.0f);
    for (std::uint32_t k = 0; k < blocks * lanes; ++k) {
      float* block = &pools_.blocks[(first_block + k / lanes) * WIDE_BLOCK_WORDS(lanes)];
      const unsigned lane = k % lanes;
      if (lane == 0) {
        const std::uint32_t first = range.first + k;
        std::memcpy(block + WIDE_FIRST(lanes), &first, sizeof first);
      }
      if (k >= range.count) { // nothing is nearer to a centre than -1
        block[WIDE_RADIUS(lanes) + lane] = -1.0f;
        block[WIDE_NORMAL(lanes, 0) + lane] = 1.0f;
        continue;
      }
      const Splat& splat = pools_.points[range.first + k];
      for (unsigned a = 0; a < 3; ++a) {
        block[WIDE_CENTRE(lanes, a) + lane] = splat.position[a];
        block[WIDE_NORMAL(lanes, a) + lane] = splat.normal[a];
      }
      block[WIDE_RADIUS(lanes) + lane] = splat.radius;
      box.add(splat);
    }
    ++pools_.leaves;
    return WIDE_LEAF | blocks << 24 | static_cast<std::uint32_t>(first_block);
  }

  const Tree& tree_;
  WidePools& pools_;
};

class Verifier {
public:
  explicit Verifier(const WidePools& pools) : pools_(pools) {}

  void run() {
    const float far = std::numeric_limits<float>::infinity();
    Box all;
    std::fill_n(all.low, 3, -far);
    std::fill_n(all.high, 3, far);
    visit(0, all, 0);
    if (next_point_ != pools_.points.size()) fail("the leaves do not hold every point");
  }

private:
  [[noreturn]] static void fail(const std::string& what) { throw std::logic_error("octree, wide form: " + what); }

  void visit(std::uint32_t index, const Box& box, unsigned depth) {
    if (index >= pools_.nodes.size() || depth >= WIDE_MAX_DEPTH)
      fail("node " + std::to_string(index) + " lies outside the pool or too deep");
    const WideNode& node = pools_.nodes[index];
    for (unsigned c = 0; c < WIDE_CHILDREN; ++c) {
      Box child;
      for (int a = 0; a < 3; ++a) {
        child.low[a] = std::max(box.low[a], node.low[a][c]);
        child.high[a] = std::min(box.high[a], node.high[a][c]);
        if (node.child[c] == 0 && node.low[a][c] <= node.high[a][c])
          fail("an empty child of node " + std::to_string(index) + " can be hit");
      }
      if (node.child[c] == 0) continue;
      if ((node.child[c] & WIDE_LEAF) != 0)
        check_leaf(node.child[c], child);
      else if (node.child[c] <= index)
        fail("node " + std::to_string(index) + " has a child before it");
      else
        visit(node.child[c], child, depth + 1);
    }
  }

  void check_leaf(std::uint32_t reference, const Box& box) {
    const unsigned lanes = pools_.lanes;
    const std::uint32_t blocks = (reference & ~WIDE_LEAF) >> 24, first = reference & WIDE_BLOCK_MASK;
    for (std::uint32_t b = first; b < first + blocks; ++b) {
      if (b >= pools_.block_count()) fail("a leaf lies outside the block pool");
      const float* block = &pools_.blocks[b * WIDE_BLOCK_WORDS(lanes)];
      std::uint32_t index;
      std::memcpy(&index, block + WIDE_FIRST(lanes), sizeof index);
      for (unsigned lane = 0; lane < lanes; ++lane) {
        if (block[WIDE_RADIUS(lanes) + lane] < 0.0f) continue;
        if (index + lane != next_point_ || next_point_ >= pools_.points.size())
          fail("block " + std::to_string(b) + " does not follow the points along the curve");
        check_splat(pools_.points[next_point_++], block, lane, box);
      }
    }
  }

  void check_splat(const OctreePoint& point, const float* block, unsigned lane, const Box& box) const {
    const unsigned lanes = pools_.lanes;
    Box own;
    own.add(point);
    for (unsigned a = 0; a < 3; ++a) {
      if (block[WIDE_CENTRE(lanes, a) + lane] != point.position[a] ||
          block[WIDE_NORMAL(lanes, a) + lane] != point.normal[a] || block[WIDE_RADIUS(lanes) + lane] != point.radius)
        fail("a block differs from the point pool");
      if (own.low[a] < box.low[a] || own.high[a] > box.high[a]) fail("a splat sticks out of a box above it");
    }
  }

  const WidePools& pools_;
  std::size_t next_point_ = 0;
};

} // namespace

WidePools pack_wide(View<Splat> splats, const Tree& tree, unsigned lanes) {
  if (tree.options.listing != Listing::centres || tree.options.axis_bits != 1)
    throw std::invalid_argument("octree: the wide form takes a tree with N = 2 that lists centres");
  if (lanes != 8 && lanes != 16) throw std::invalid_argument("octree: the wide form has 8 or 16 lanes");
  WidePools pools;
  pools.lanes = lanes;
  pools.source = tree.order;
  pools.points.reserve(splats.size);
  for (std::uint32_t input : tree.order)
    pools.points.push_back(splats[input]);
  Packer(tree, pools).run();
  return pools;
}

void verify(const WidePools& pools) {
  Verifier(pools).run();
}

} // namespace pointgi
