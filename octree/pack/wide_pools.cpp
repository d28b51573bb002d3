#include "octree/pack/wide_pools.h"
#include "octree/build/disc_cell.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace pointgi {

namespace {

struct Box {
  float low[3] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                  std::numeric_limits<float>::infinity()};
  float high[3] = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity()};

  void add(const Splat& splat, const Slab& slab) {
    float half[3];
    disc_half_extents(splat, half, slab);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], slab_centre(splat, slab, a) - half[a] - cell_margin);
      high[a] = std::max(high[a], slab_centre(splat, slab, a) + half[a] + cell_margin);
    }
  }
};

Slab slab_at(const WidePools& pools, std::size_t point) {
  return pools.bends.empty() ? Slab{} : slab_of(pools.bends[point], pools.points[point].radius);
}

struct Range {
  std::uint32_t first, count;
};

/// Lays nodes and leaves out along the curve on one thread, which is little work, then fills the pools on all.
class Packer {
public:
  Packer(View<Splat> splats, const Tree& tree, const SplatClips& clips, View<PatchBend> bends, WidePools& pools)
      : splats_(splats), tree_(tree), clips_(clips), bends_(bends), curve_(tree.options.order, tree.options.axis_bits),
        pools_(pools) {}

  void run() {
    const TreeNode& root = tree_.nodes[0];
    const std::uint32_t index = new_node(0);
    if (root.first_child != 0)
      lay_out_children(root, index, 0, Curve::start);
    else
      lay_out_range({root.first_point, root.count}, index, 0, 0, Curve::start);
    pools_.depth = static_cast<unsigned>(levels_.size());
    pools_.leaves = leaves_.size();
    pools_.nodes.resize(children_.size());
    pools_.bends.resize(bends_.size);
    pools_.blocks.resize(blocks_ * pools_.block_words() + CLIP_WORDS * clips_.size());
    pools_.points.resize(splats_.size);
    pools_.source.resize(splats_.size);
    parallel_ranges(leaves_.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf)
        fill_leaf(leaves_[leaf]);
    });
    // From the deepest level up, so that the boxes of a node's children are there before its own.
    for (std::size_t level = levels_.size(); level-- > 0;)
      parallel_ranges(levels_[level].size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          fill_node(levels_[level][i]);
      });
    if (!clips_.empty()) write_clips();
  }

private:
  struct Leaf {
    Range range;
    std::uint32_t node, child; ///< whose child it is
    std::uint32_t first_block;
  };

  std::uint32_t largest_leaf() const { return WIDE_MAX_BLOCKS * pools_.lanes; }

  std::uint32_t new_node(unsigned level) {
    const auto index = static_cast<std::uint32_t>(children_.size());
    children_.push_back({});
    levels_.resize(std::max<std::size_t>(levels_.size(), level + 1));
    levels_[level].push_back(index);
    return index;
  }

  void lay_out_children(const TreeNode& node, std::uint32_t index, unsigned level, unsigned state) {
    for (unsigned place = 0; place < WIDE_CHILDREN; ++place) {
      const unsigned c = curve_.child(state, place), next = curve_.next(state, place);
      const TreeNode& child = tree_.nodes[node.first_child + c];
      if (child.first_child == 0) {
        lay_out_range({child.first_point, child.count}, index, c, level, next);
      } else {
        children_[index][c] = new_node(level + 1);
        lay_out_children(child, children_[index][c], level + 1, next);
      }
    }
  }

  /// Makes a leaf child `c` of a node; more splats than a leaf holds become a node, its children parts of the range.
  void lay_out_range(Range range, std::uint32_t index, unsigned c, unsigned level, unsigned state) {
    if (range.count == 0) return;
    if (range.count <= largest_leaf()) {
      const std::uint32_t blocks = (range.count + pools_.lanes - 1) / pools_.lanes;
      if (blocks_ + blocks > WIDE_BLOCK_MASK)
        throw std::length_error("octree: more leaf blocks than the wide form has addresses for; raise the leaf "
                                "capacity");
      children_[index][c] = WIDE_LEAF | blocks << 24 | blocks_;
      leaves_.push_back({range, index, c, blocks_});
      blocks_ += blocks;
      return;
    }
    const std::uint32_t cut = children_[index][c] = new_node(level + 1);
    const std::uint32_t part = (range.count + WIDE_CHILDREN - 1) / WIDE_CHILDREN;
    for (std::uint32_t place = 0, at = 0; at < range.count; at += part, ++place)
      lay_out_range({range.first + at, std::min(part, range.count - at)}, cut, curve_.child(state, place), level + 1,
                    curve_.next(state, place));
  }

  void fill_leaf(const Leaf& leaf) {
    const unsigned lanes = pools_.lanes;
    const std::uint32_t blocks = (leaf.range.count + lanes - 1) / lanes;
    const std::size_t words = pools_.block_words();
    float* block = &pools_.blocks[leaf.first_block * words];
    // Apart from the rest, because of what follows a processor waits for each splat, and here fetches many at a time.
    for (std::uint32_t point = leaf.range.first; point < leaf.range.first + leaf.range.count; ++point) {
      pools_.source[point] = tree_.order[point];
      pools_.points[point] = splats_[tree_.order[point]];
      if (bends_.size != 0) pools_.bends[point] = bends_[tree_.order[point]];
    }
    Box box;
    for (std::uint32_t b = 0; b < blocks; ++b, block += words) {
      std::fill_n(block, words, 0.0f);
      const std::uint32_t first = leaf.range.first + b * lanes, past = leaf.range.first + leaf.range.count;
      std::memcpy(block + WIDE_FIRST(lanes), &first, sizeof first);
      pg_uint sheets = 0, flat = 0;
      for (unsigned lane = 0; lane < lanes; ++lane) {
        if (first + lane >= past) { // nothing is nearer to a centre than -1
          block[WIDE_RADIUS(lanes) + lane] = -1.0f;
          block[WIDE_NORMAL(lanes, 0) + lane] = 1.0f;
          continue;
        }
        const Splat& splat = pools_.points[first + lane];
        for (unsigned a = 0; a < 3; ++a) {
          block[WIDE_CENTRE(lanes, a) + lane] = splat.position[a];
          block[WIDE_NORMAL(lanes, a) + lane] = splat.normal[a];
        }
        block[WIDE_RADIUS(lanes) + lane] = splat.radius;
        if (is_sheet(splat)) sheets |= 1u << lane;
        if (is_flat(splat)) flat |= 1u << lane;
        if (bends_.size != 0) set_bend(block, lane, pools_.bends[first + lane]);
        box.add(splat, slab_at(pools_, first + lane));
      }
      std::memcpy(block + WIDE_SHEETS(lanes), &sheets, sizeof sheets);
      std::memcpy(block + WIDE_FLAT(lanes), &flat, sizeof flat);
    }
    set_box(pools_.nodes[leaf.node], leaf.child, box);
  }

  void set_bend(float* block, unsigned lane, const PatchBend& bend) const {
    block[WIDE_BEND(pools_.lanes, 0) + lane] = bend.xx;
    block[WIDE_BEND(pools_.lanes, 1) + lane] = bend.xy;
    block[WIDE_BEND(pools_.lanes, 2) + lane] = bend.yy;
  }

  /// Behind the blocks, in the order of the points, each block told of its own.
  void write_clips() {
    const std::vector<std::uint32_t> clip_of = clip_of_each(clips_, splats_.size);
    std::size_t at = blocks_ * pools_.block_words();
    if (pools_.blocks.size() > std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("octree: more leaf blocks and clips than 32 bits count; raise the leaf capacity");
    std::uint32_t point = 0;
    for (std::size_t b = 0; b < blocks_; ++b) {
      float* block = &pools_.blocks[b * pools_.block_words()];
      const auto first = static_cast<std::uint32_t>(at);
      pg_uint clipped = 0;
      for (unsigned lane = 0; lane < pools_.lanes && block[WIDE_RADIUS(pools_.lanes) + lane] >= 0.0f; ++lane, ++point) {
        const std::uint32_t k = clip_of[pools_.source[point]];
        if (k == no_clip) continue;
        clipped |= 1u << lane;
        std::memcpy(&pools_.blocks[at], &clips_[k].clip, sizeof(DiscClip));
        at += CLIP_WORDS;
        pools_.clips.push_back({point, clips_[k].clip});
      }
      std::memcpy(block + WIDE_CLIPPED(pools_.lanes), &clipped, sizeof clipped);
      std::memcpy(block + WIDE_CLIPS(pools_.lanes), &first, sizeof first);
    }
  }

  static void set_box(WideNode& node, unsigned c, const Box& box) {
    for (int a = 0; a < 3; ++a) {
      node.low[a][c] = box.low[a];
      node.high[a][c] = box.high[a];
    }
  }

  /// References, and the boxes of those children that are no leaves.
  void fill_node(std::uint32_t index) {
    // An empty child's box is inverted, and finite: infinities would turn into NaN where a ray runs along an axis.
    constexpr float far = 1e18f;
    constexpr Box empty{{far, far, far}, {-far, -far, -far}};
    WideNode& node = pools_.nodes[index];
    for (unsigned c = 0; c < WIDE_CHILDREN; ++c) {
      const std::uint32_t child = node.child[c] = children_[index][c];
      if (child == 0)
        set_box(node, c, empty);
      else if ((child & WIDE_LEAF) == 0)
        set_box(node, c, box_of(pools_.nodes[child]));
    }
  }

  static Box box_of(const WideNode& node) {
    Box box;
    for (unsigned a = 0; a < 3; ++a) {
      box.low[a] = *std::min_element(node.low[a], node.low[a] + WIDE_CHILDREN);
      box.high[a] = *std::max_element(node.high[a], node.high[a] + WIDE_CHILDREN);
    }
    return box;
  }

  View<Splat> splats_;
  const Tree& tree_;
  const SplatClips& clips_;
  View<PatchBend> bends_;
  Curve curve_;
  WidePools& pools_;
  std::vector<std::array<std::uint32_t, WIDE_CHILDREN>> children_; ///< of each node, as WideNode::child
  std::vector<std::vector<std::uint32_t>> levels_;                 ///< the nodes of each level
  std::vector<Leaf> leaves_;                                       ///< along the curve
  std::uint32_t blocks_ = 0;
};

class Verifier {
public:
  explicit Verifier(const WidePools& pools) : pools_(pools), curve_(pools.order, 1) {}

  void run() {
    const float far = std::numeric_limits<float>::infinity();
    Box all;
    std::fill_n(all.low, 3, -far);
    std::fill_n(all.high, 3, far);
    visit(0, all, 0, Curve::start);
    if (next_point_ != pools_.points.size()) fail("the leaves do not hold every point");
    if (next_clip_ != pools_.clips.size()) fail("the blocks do not know every clip");
  }

private:
  [[noreturn]] static void fail(const std::string& what) { throw std::logic_error("octree, wide form: " + what); }

  void visit(std::uint32_t index, const Box& box, unsigned depth, unsigned state) {
    if (index >= pools_.nodes.size() || depth >= WIDE_MAX_DEPTH)
      fail("node " + std::to_string(index) + " lies outside the pool or too deep");
    const WideNode& node = pools_.nodes[index];
    for (unsigned place = 0; place < WIDE_CHILDREN; ++place) {
      const unsigned c = curve_.child(state, place);
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
        visit(node.child[c], child, depth + 1, curve_.next(state, place));
    }
  }

  void check_leaf(std::uint32_t reference, const Box& box) {
    const unsigned lanes = pools_.lanes;
    const std::uint32_t blocks = (reference & ~WIDE_LEAF) >> 24, first = reference & WIDE_BLOCK_MASK;
    for (std::uint32_t b = first; b < first + blocks; ++b) {
      if (b >= pools_.block_count()) fail("a leaf lies outside the block pool");
      const float* block = &pools_.blocks[b * pools_.block_words()];
      std::uint32_t index;
      std::memcpy(&index, block + WIDE_FIRST(lanes), sizeof index);
      pg_uint sheets, flat, clipped, clips;
      std::memcpy(&sheets, block + WIDE_SHEETS(lanes), sizeof sheets);
      std::memcpy(&flat, block + WIDE_FLAT(lanes), sizeof flat);
      std::memcpy(&clipped, block + WIDE_CLIPPED(lanes), sizeof clipped);
      std::memcpy(&clips, block + WIDE_CLIPS(lanes), sizeof clips);
      const std::size_t first_clip = next_clip_;
      for (unsigned lane = 0; lane < lanes; ++lane) {
        if (block[WIDE_RADIUS(lanes) + lane] < 0.0f) continue;
        if (index + lane != next_point_ || next_point_ >= pools_.points.size())
          fail("block " + std::to_string(b) + " does not follow the points along the curve");
        if ((sheets >> lane & 1u) != (is_sheet(pools_.points[next_point_]) ? 1u : 0u))
          fail("block " + std::to_string(b) + " does not know which of its splats are sheets");
        if ((flat >> lane & 1u) != (is_flat(pools_.points[next_point_]) ? 1u : 0u))
          fail("block " + std::to_string(b) + " does not know which of its splats are flat");
        if ((clipped >> lane & 1u) != 0u) check_clip(clips + CLIP_WORDS * (next_clip_ - first_clip), b);
        check_splat(next_point_++, block, lane, box);
      }
    }
  }

  /// The next clip of the list is that of the next point, and stands at `word`.
  void check_clip(std::size_t word, std::uint32_t block) {
    if (next_clip_ >= pools_.clips.size() || pools_.clips[next_clip_].splat != next_point_ ||
        std::memcmp(&pools_.blocks[word], &pools_.clips[next_clip_].clip, sizeof(DiscClip)) != 0)
      fail("block " + std::to_string(block) + " has a clip that is not its splat's");
    ++next_clip_;
  }

  void check_splat(std::size_t index, const float* block, unsigned lane, const Box& box) const {
    const unsigned lanes = pools_.lanes;
    const OctreePoint& point = pools_.points[index];
    Box own;
    own.add(point, slab_at(pools_, index));
    if (!pools_.bends.empty()) {
      const PatchBend& bend = pools_.bends[index];
      const float terms[3] = {bend.xx, bend.xy, bend.yy};
      for (int term = 0; term < 3; ++term)
        if (block[WIDE_BEND(lanes, term) + lane] != terms[term]) fail("a block has a bend that is not its splat's");
    }
    for (unsigned a = 0; a < 3; ++a) {
      if (block[WIDE_CENTRE(lanes, a) + lane] != point.position[a] ||
          block[WIDE_NORMAL(lanes, a) + lane] != point.normal[a] || block[WIDE_RADIUS(lanes) + lane] != point.radius)
        fail("a block differs from the point pool");
      if (own.low[a] < box.low[a] || own.high[a] > box.high[a]) fail("a splat sticks out of a box above it");
    }
  }

  const WidePools& pools_;
  Curve curve_;
  std::size_t next_point_ = 0, next_clip_ = 0;
};

} // namespace

WidePools pack_wide(View<Splat> splats, const Tree& tree, unsigned lanes, const SplatClips& clips,
                    View<PatchBend> bends) {
  if (tree.options.listing != Listing::centres || tree.options.axis_bits != 1)
    throw std::invalid_argument("octree: the wide form takes a tree with N = 2 that lists centres");
  if (lanes != 8 && lanes != 16) throw std::invalid_argument("octree: the wide form has 8 or 16 lanes");
  WidePools pools;
  pools.lanes = lanes;
  pools.order = tree.options.order;
  Packer(splats, tree, clips, bends, pools).run();
  return pools;
}

void verify(const WidePools& pools) {
  Verifier(pools).run();
}

} // namespace pointgi
