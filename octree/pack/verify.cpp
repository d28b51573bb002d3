#include "octree/build/disc_cell.h"
#include "octree/pack/step_pools.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace pointgi {

namespace {

class Verifier {
public:
  explicit Verifier(const StepPools& pools)
      : pools_(pools), curve_(pools.order, pools.axis_bits), reached_(pools.nodes.size(), false),
        next_entry_(StepPools::first_entry(pools.clips.size(), pools.points.size())) {}

  void run() {
    if (pools_.nodes.empty() || pools_.begin_end.empty()) fail(0, "the pools are empty");
    if (!pools_.bends.empty() && pools_.bends.size() != pools_.points.size()) fail(0, "some points have no bend");
    visit(0, Cell{{0.0f, 0.0f, 0.0f}, 1.0f}, 0, Curve::start, {});
    if (std::find(reached_.begin(), reached_.end(), false) != reached_.end())
      fail(static_cast<std::size_t>(std::find(reached_.begin(), reached_.end(), false) - reached_.begin()),
           "is nobody's child");
    if (next_point_ != pools_.points.size()) fail(0, "the leaves do not own every point");
    for (const ClippedSplat& c : pools_.clips)
      if (std::memcmp(&pools_.begin_end[pools_.begin_end[c.splat]], &c.clip, sizeof c.clip) != 0)
        fail(0, "has a clip that differs from its splat's");
    if (next_entry_ + 1 != pools_.begin_end.size() || pools_.begin_end.back() != pools_.points.size())
      fail(0, "the Begin-End pool does not end with the number of points");
  }

private:
  [[noreturn]] static void fail(std::size_t node, const std::string& what) {
    throw std::logic_error("octree: node " + std::to_string(node) + ": " + what);
  }

  /// `touching`: points owned elsewhere whose discs touch this cell, found without the builder's lists.
  void visit(std::uint32_t index, const Cell& cell, unsigned level, unsigned state,
             const std::vector<std::uint32_t>& touching) {
    if (index >= pools_.nodes.size()) fail(index, "lies outside the pool");
    if (reached_[index]) fail(index, "is reached twice");
    reached_[index] = true;
    const OctreeNode& node = pools_.nodes[index];
    if (NODE_LEVEL(node.header) != level) fail(index, "has the wrong level");
    switch (NODE_TYPE(node.header)) {
    case NODE_EMPTY:
      if (!touching.empty() || node.count != 0) fail(index, "is called empty, yet a splat touches it");
      return;
    case NODE_LEAF:
      check_leaf(index, node, cell, touching);
      return;
    case NODE_INTERNAL:
      visit_children(index, node, cell, level, state, touching);
      return;
    default:
      fail(index, "has an unknown type");
    }
  }

  void check_leaf(std::uint32_t index, const OctreeNode& node, const Cell& cell,
                  const std::vector<std::uint32_t>& touching) {
    if (node.address != next_entry_) fail(index, "does not follow the leaf before it in the Begin-End pool");
    const std::size_t end_entry = node.address + 1u + node.extra;
    if (end_entry >= pools_.begin_end.size()) fail(index, "has an entry outside the Begin-End pool");
    const std::uint32_t begin = pools_.begin_end[node.address], end = pools_.begin_end[end_entry];
    if (begin != next_point_ || end < begin || end - begin != node.count || end > pools_.points.size())
      fail(index, "owns a wrong range of points");
    for (std::uint32_t p = begin; p < end; ++p)
      if (!contains(cell, pools_.points[p])) fail(index, "owns a point outside its cell");
    std::vector<std::uint32_t> listed(pools_.begin_end.begin() + node.address + 1,
                                      pools_.begin_end.begin() + static_cast<std::ptrdiff_t>(end_entry));
    std::sort(listed.begin(), listed.end());
    if (std::adjacent_find(listed.begin(), listed.end()) != listed.end()) fail(index, "lists a splat twice");
    for (std::uint32_t p : listed)
      if (p >= pools_.points.size() || (p >= begin && p < end)) fail(index, "lists a splat that is no extra one");
    for (std::uint32_t p : touching)
      if (!std::binary_search(listed.begin(), listed.end(), p)) fail(index, "does not list a splat that touches it");
    next_point_ = end;
    next_entry_ = static_cast<std::uint32_t>(end_entry);
  }

  void visit_children(std::uint32_t index, const OctreeNode& node, const Cell& cell, unsigned level, unsigned state,
                      const std::vector<std::uint32_t>& touching) {
    const unsigned n = 1u << pools_.axis_bits, children = n * n * n;
    if (level >= key_levels(pools_.axis_bits)) fail(index, "lies too deep to have children");
    if (node.extra != next_point_ || node.count > pools_.points.size() - node.extra)
      fail(index, "spans a wrong range of points");
    const std::uint32_t first = node.extra, past = node.extra + node.count;
    for (unsigned place = 0; place < children; ++place) {
      const unsigned c = curve_.child(state, place);
      const unsigned position[3] = {c % n, c / n % n, c / n / n};
      Cell child{{}, cell.side / static_cast<float>(n)};
      for (int a = 0; a < 3; ++a)
        child.low[a] = cell.low[a] + child.side * static_cast<float>(position[a]);
      std::vector<std::uint32_t> candidates;
      const auto keep = [&](std::uint32_t p) {
        float half[3];
        const Slab slab = pools_.bends.empty() ? Slab{} : slab_of(pools_.bends[p], pools_.points[p].radius);
        disc_half_extents(pools_.points[p], half, slab);
        if (!contains(child, pools_.points[p]) && disc_touches_cell(pools_.points[p], half, child, slab))
          candidates.push_back(p);
      };
      for (std::uint32_t p = first; p < past; ++p)
        keep(p);
      for (std::uint32_t p : touching)
        keep(p);
      visit(node.address + c, child, level + 1, curve_.next(state, place), candidates);
    }
    if (next_point_ != past) fail(index, "has children that do not own its points");
  }

  static bool contains(const Cell& cell, const OctreePoint& point) {
    // In finest cells, as the builder counts, so that a point on a face has one owner.
    const CellCoordinates at = cell_of(point.position);
    constexpr float cells = static_cast<float>(1u << MAX_AXIS_BITS);
    for (int a = 0; a < 3; ++a) {
      const auto low = static_cast<std::uint32_t>(cell.low[a] * cells);
      const auto side = static_cast<std::uint32_t>(cell.side * cells);
      if (at[a] < low || at[a] >= low + side) return false;
    }
    return true;
  }

  const StepPools& pools_;
  Curve curve_;
  std::vector<bool> reached_;
  std::uint32_t next_point_ = 0;
  std::uint32_t next_entry_;
};

} // namespace

void verify(const StepPools& pools) {
  Verifier(pools).run();
}

} // namespace pointgi
