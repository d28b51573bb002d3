#pragma once
/// The thesis' form of the octree: node pool, Begin-End pool with extra splats, point pool (method.md §2); bytes as the
/// `step` traversal reads them.
#include "octree/build/tree.h"

namespace pointgi {

struct StepPools {
  Pool<OctreeNode> nodes;
  Pool<std::uint32_t> begin_end;
  Pool<OctreePoint> points;   ///< along the curve
  Pool<std::uint32_t> source; ///< input index of each point of the pool
  SplatClips clips;           ///< of the points of the pool
  PatchBends bends;           ///< of the points of the pool; empty where all are discs
  unsigned axis_bits = 1;
  PointOrder order = PointOrder::morton; ///< of nodes, Begin-End entries and points
  unsigned depth = 0;
  std::size_t leaves = 0;
  std::size_t extra_splats = 0;

  /// Where the first leaf's entry stands in the Begin-End pool: behind the clips, if there are any.
  static std::uint32_t first_entry(std::size_t clips, std::size_t points) {
    return clips == 0 ? 0u : static_cast<std::uint32_t>(points + CLIP_WORDS * clips);
  }

  std::size_t bytes() const {
    return nodes.size() * sizeof(OctreeNode) + begin_end.size() * sizeof(std::uint32_t) +
           points.size() * sizeof(OctreePoint) + bends.size() * sizeof(PatchBend);
  }
};

/// Packs a tree over the same splats (and the same bends), of which some end at borders, on all cores; the same pools
/// for any number of them. Throws std::length_error when the Begin-End pool outgrows 32-bit addresses.
StepPools pack_step(View<Splat> splats, const Tree& tree, const SplatClips& clips = {}, View<PatchBend> bends = {});

/// Checks every invariant that the traversal relies on: types, child blocks inside the pool and each used once, levels,
/// own points inside their cell and each in one leaf, Begin-End entries along the curve and closed, every leaf that a
/// disc, or its patch, touches lists it and no leaf lists a splat twice. Throws std::logic_error naming the first node
/// that breaks one. Time O(n log n); the tests and debug builds call it.
void verify(const StepPools& pools);

} // namespace pointgi
