#pragma once
/// The wide form of the octree: tight child boxes and structure-of-arrays leaf blocks, for devices with wide vectors.
#include "octree/build/tree.h"

namespace pointgi {

struct WidePools {
  Pool<WideNode> nodes; ///< nodes[0] is the root; children stand behind their parents
  Pool<float> blocks;   ///< block_words() words a block (whole numbers by their bits), then the clips
  Pool<OctreePoint> points;
  Pool<std::uint32_t> source; ///< input index of each point of the pool
  SplatClips clips;           ///< of the points of the pool
  PatchBends bends;           ///< of the points of the pool; empty where all are discs
  unsigned lanes = 8;
  PointOrder order = PointOrder::morton; ///< of nodes, blocks and points
  unsigned depth = 0;
  std::size_t leaves = 0;

  std::size_t block_words() const {
    return bends.empty() ? WIDE_DISC_BLOCK_WORDS(lanes) : WIDE_PATCH_BLOCK_WORDS(lanes);
  }
  std::size_t block_count() const { return (blocks.size() - CLIP_WORDS * clips.size()) / block_words(); }
  std::size_t bytes() const {
    return nodes.size() * sizeof(WideNode) + blocks.size() * sizeof(float) + points.size() * sizeof(OctreePoint) +
           bends.size() * sizeof(PatchBend);
  }
};

/// Packs a tree built with Listing::centres and N = 2 over the same splats, of which some end at borders, as discs or,
/// with `bends`, as patches; `lanes` is 8 or 16. A leaf with more splats than WIDE_MAX_BLOCKS blocks hold (coincident
/// points) is cut into nodes of its own. Works on all cores; the same pools for any number of them. Throws
/// std::invalid_argument on another tree, std::length_error when there are more blocks than addresses.
WidePools pack_wide(View<Splat> splats, const Tree& tree, unsigned lanes, const SplatClips& clips = {},
                    View<PatchBend> bends = {});

/// Checks that every point lies in one block, blocks along the curve, inside all boxes above it, that unused lanes
/// cannot be hit and that the depth fits the traversal's stack. Throws std::logic_error naming what breaks.
void verify(const WidePools& pools);

} // namespace pointgi
