#include "octree/pack/step_pools.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace pointgi {

namespace {

/// Lays nodes and leaves out along the curve on one thread, then copies what they list on all.
class Packer {
public:
  Packer(View<Splat> splats, const Tree& tree, const SplatClips& clips, StepPools& pools)
      : splats_(splats), tree_(tree), clips_(clips), curve_(tree.options.order, tree.options.axis_bits), pools_(pools),
        next_entry_(pools.first_entry(clips.size(), splats.size)) {}

  void run() {
    pools_.nodes.resize(tree_.nodes.size());
    pack_node(tree_.nodes[0], 0, Curve::start);
    pools_.leaves = leaves_.size();
    pools_.begin_end.resize(next_entry_ + 1u);
    pools_.begin_end.back() = static_cast<std::uint32_t>(splats_.size);
    parallel_ranges(leaves_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf)
        copy_entries(leaves_[leaf]);
    });
    pools_.points.resize(splats_.size);
    pools_.source.resize(splats_.size);
    parallel_ranges(splats_.size, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        pools_.source[p] = tree_.order[p];
        pools_.points[p] = splats_[tree_.order[p]];
      }
    });
    if (!clips_.empty()) write_clips();
  }

private:
  struct Leaf {
    const TreeNode* node;
    std::uint32_t first_entry;
  };

  /// Leaves are met in the order of the curve, so that the Begin-End pool's next entry closes the one before.
  void pack_node(const TreeNode& node, std::uint32_t index, unsigned state) {
    OctreeNode& packed = pools_.nodes[index];
    if (node.first_child != 0) {
      const std::uint32_t children = 1u << (3 * tree_.options.axis_bits), first = next_node_;
      next_node_ += children;
      packed = {NODE_HEADER(NODE_INTERNAL, node.level), first, node.first_point, node.count};
      for (std::uint32_t place = 0; place < children; ++place) {
        const unsigned c = curve_.child(state, place);
        pack_node(tree_.nodes[node.first_child + c], first + c, curve_.next(state, place));
      }
    } else if (node.count + node.extra_count == 0) {
      packed = {NODE_HEADER(NODE_EMPTY, node.level), 0, 0, 0};
    } else {
      packed = {NODE_HEADER(NODE_LEAF, node.level), next_entry_, node.extra_count, node.count};
      leaves_.push_back({&node, next_entry_});
      next_entry_ += 1u + node.extra_count;
    }
  }

  void copy_entries(const Leaf& leaf) {
    auto entry = pools_.begin_end.begin() + leaf.first_entry;
    *entry++ = leaf.node->first_point;
    std::copy_n(tree_.extra.begin() + leaf.node->first_extra, leaf.node->extra_count, entry);
  }

  /// The entries before the first leaf's.
  void write_clips() {
    const std::vector<std::uint32_t> clip_of = clip_of_each(clips_, splats_.size);
    auto at = static_cast<std::uint32_t>(splats_.size);
    for (std::uint32_t p = 0; p < splats_.size; ++p) {
      const std::uint32_t k = clip_of[tree_.order[p]];
      pools_.begin_end[p] = k == no_clip ? 0u : at;
      if (k == no_clip) continue;
      std::memcpy(&pools_.begin_end[at], &clips_[k].clip, sizeof(DiscClip));
      at += CLIP_WORDS;
      pools_.clips.push_back({p, clips_[k].clip});
    }
  }

  View<Splat> splats_;
  const Tree& tree_;
  const SplatClips& clips_;
  Curve curve_;
  StepPools& pools_;
  std::vector<Leaf> leaves_; ///< along the curve
  std::uint32_t next_node_ = 1, next_entry_;
};

} // namespace

StepPools pack_step(View<Splat> splats, const Tree& tree, const SplatClips& clips, View<PatchBend> bends) {
  const std::size_t before = StepPools::first_entry(clips.size(), splats.size);
  if (tree.extra.size() + tree.nodes.size() + before >= std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("octree: the Begin-End pool outgrows 32-bit addresses; raise the leaf capacity");
  StepPools pools;
  pools.axis_bits = tree.options.axis_bits;
  pools.order = tree.options.order;
  pools.depth = tree.depth;
  pools.extra_splats = tree.extra.size();
  Packer(splats, tree, clips, pools).run();
  pools.bends = bends_along(bends, pools.source);
  return pools;
}

} // namespace pointgi
