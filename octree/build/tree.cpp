#include "octree/build/tree.h"
#include "octree/build/disc_cell.h"
#include "octree/build/key_sort.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pointgi {

namespace {

/// What one more cell on a ray's way costs, in splat tests: the descent from the root and the exit plane.
/// Found by rendering the test clouds with 2, 4, 8 and 16; flat around this value.
constexpr double step_cost = 4.0;

/// A cell that lists no more splats is divided down to its leaves by one thread; larger ones, near the root, one after
/// the other, with all threads at each. Small enough that 50,000 splats keep some cores busy.
constexpr std::size_t task_splats = 4096;

/// Splats that a thread takes at a time where it does the same for all of them.
constexpr std::size_t grain = 8192;

using Lists = std::vector<std::vector<std::uint32_t>>; ///< one a child

/// A part of the tree with numbers of its own; nodes[0] is its root.
struct Part {
  std::uint32_t place = 0; ///< the node of the part above that its root is
  std::vector<TreeNode> nodes;
  std::vector<std::uint32_t> extra;
  unsigned depth = 0;
};

/// A node of a part, and what its division has to know of it.
struct Task {
  std::uint32_t node = 0;
  unsigned state = Curve::start;
  Cell cell{{0.0f, 0.0f, 0.0f}, 1.0f};
  std::vector<std::uint32_t> extra;
};

class Builder {
public:
  Builder(View<Splat> splats, const TreeOptions& options, View<PatchBend> bends)
      : options_(options), curve_(options.order, options.axis_bits), children_(1u << (3 * options.axis_bits)) {
    tree_.options = options;
    sort_along_curve(splats, bends);
    Part top;
    top.nodes.emplace_back();
    top.nodes[0].count = static_cast<std::uint32_t>(splats.size);
    std::vector<Task> tasks;
    divide(top, Task{}, &tasks);
    std::vector<Part> parts(tasks.size());
    parallel_ranges(tasks.size(), 1, [&](std::size_t t, std::size_t) {
      parts[t].place = std::exchange(tasks[t].node, 0u);
      parts[t].nodes.push_back(top.nodes[parts[t].place]);
      divide(parts[t], std::move(tasks[t]), nullptr);
    });
    join(top, parts);
  }

  Tree take() { return std::move(tree_); }

private:
  void sort_along_curve(View<Splat> splats, View<PatchBend> bends) {
    items_.resize(splats.size);
    parallel_ranges(splats.size, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        items_[i] = {curve_.key(cell_of(splats[i].position)), static_cast<std::uint32_t>(i)};
    });
    sort_by_key(items_);
    tree_.order.resize(splats.size);
    const bool listing = options_.listing == Listing::overlaps;
    splats_.resize(listing ? splats.size : 0);
    half_.resize(listing ? splats.size : 0);
    slab_.resize(listing ? bends.size : 0);
    parallel_ranges(splats.size, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        tree_.order[k] = items_[k].index;
        if (!listing) continue;
        splats_[k] = splats[items_[k].index];
        if (!slab_.empty()) slab_[k] = slab_of(bends[items_[k].index], splats_[k].radius);
        disc_half_extents(splats_[k], half_[k].data(), slab_at(k));
      }
    });
  }

  Slab slab_at(std::size_t k) const { return slab_.empty() ? Slab{} : slab_[k]; }

  /// First own point of each child in the order of the curve, and one past the last; the keys are sorted, so each
  /// border is a binary search.
  std::vector<std::uint32_t> child_borders(const TreeNode& node) const {
    const unsigned shift = 3 * options_.axis_bits * (key_levels(options_.axis_bits) - 1 - node.level);
    std::vector<std::uint32_t> borders(children_ + 1);
    auto at = items_.begin() + node.first_point;
    const auto end = at + node.count;
    for (unsigned place = 0; place < children_; ++place) {
      at = std::partition_point(at, end, [&](const KeyedIndex& item) {
        return static_cast<unsigned>((item.key >> shift) & (children_ - 1)) < place;
      });
      borders[place] = static_cast<std::uint32_t>(at - items_.begin());
    }
    borders[children_] = node.first_point + node.count;
    return borders;
  }

  Cell child_cell(const Cell& cell, unsigned child) const {
    const unsigned mask = (1u << options_.axis_bits) - 1u;
    const float side = cell.side / static_cast<float>(mask + 1u);
    Cell result{{}, side};
    for (unsigned a = 0; a < 3; ++a)
      result.low[a] = cell.low[a] + side * static_cast<float>((child >> (a * options_.axis_bits)) & mask);
    return result;
  }

  /// Adds `point` to the lists of those children that its disc touches and that do not own it.
  void list_in_children(std::uint32_t point, unsigned owner, const Cell& cell, Lists& lists) const {
    const int n = 1 << options_.axis_bits;
    const float side = cell.side / static_cast<float>(n);
    const Slab slab = slab_at(point);
    int from[3], to[3];
    for (int a = 0; a < 3; ++a) {
      const float centre = slab_centre(splats_[point], slab, a) - cell.low[a], reach = half_[point][a] + cell_margin;
      from[a] = std::clamp(static_cast<int>(std::floor((centre - reach) / side)), 0, n - 1);
      to[a] = std::clamp(static_cast<int>(std::floor((centre + reach) / side)), 0, n - 1);
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) {
          const unsigned child = static_cast<unsigned>(x + n * (y + n * z));
          if (child != owner && disc_touches_cell(splats_[point], half_[point].data(), child_cell(cell, child), slab))
            lists[child].push_back(point);
        }
  }

  /// The extra splats of all children: own points of their siblings along the curve, then the cell's own extra splats.
  Lists list_splats(const TreeNode& node, const Task& task, const std::vector<std::uint32_t>& borders) const {
    const std::size_t listed = node.count + task.extra.size();
    std::vector<Lists> found((listed + grain - 1) / grain);
    parallel_ranges(listed, grain, [&](std::size_t begin, std::size_t end) {
      Lists& lists = found[begin / grain];
      lists.resize(children_);
      unsigned place = 0;
      for (std::size_t i = begin; i < end; ++i) {
        if (i >= node.count) {
          list_in_children(task.extra[i - node.count], children_, task.cell, lists);
          continue;
        }
        const auto point = static_cast<std::uint32_t>(node.first_point + i);
        while (point >= borders[place + 1])
          ++place;
        list_in_children(point, curve_.child(task.state, place), task.cell, lists);
      }
    });
    Lists lists = std::move(found[0]);
    for (std::size_t range = 1; range < found.size(); ++range)
      for (unsigned c = 0; c < children_; ++c)
        lists[c].insert(lists[c].end(), found[range][c].begin(), found[range][c].end());
    return lists;
  }

  /// Expected splat tests of a ray that enters the cell, after dividing it: a child is met with the share that its
  /// faces have of the cell's, 1/N² (the surface-area heuristic).
  bool dividing_pays(std::size_t own, std::size_t extra, const Lists& lists) const {
    std::size_t after = own;
    for (const auto& list : lists)
      after += list.size();
    const double n = 1u << options_.axis_bits;
    return (static_cast<double>(after) + step_cost * children_) / (n * n) <
           static_cast<double>(own + extra) + step_cost;
  }

  /// Divides a node of `part` down to its leaves; cells of at most task_splats splats are put off into `later`, if
  /// given.
  void divide(Part& part, Task task, std::vector<Task>* later) const {
    const TreeNode node = part.nodes[task.node];
    const std::size_t listed = node.count + task.extra.size();
    if (later != nullptr && listed <= task_splats) {
      later->push_back(std::move(task));
      return;
    }
    part.depth = std::max(part.depth, node.level);
    if (listed > options_.leaf_capacity && node.level < options_.max_depth) {
      const std::vector<std::uint32_t> borders = child_borders(node);
      const bool listing = options_.listing == Listing::overlaps;
      Lists lists = listing ? list_splats(node, task, borders) : Lists(children_);
      if (!listing || dividing_pays(node.count, task.extra.size(), lists)) {
        add_children(part, task, borders, lists, later);
        return;
      }
    }
    part.nodes[task.node].first_extra = static_cast<std::uint32_t>(part.extra.size());
    part.nodes[task.node].extra_count = static_cast<std::uint32_t>(task.extra.size());
    part.extra.insert(part.extra.end(), task.extra.begin(), task.extra.end());
  }

  void add_children(Part& part, const Task& task, const std::vector<std::uint32_t>& borders, Lists& lists,
                    std::vector<Task>* later) const {
    const auto first = static_cast<std::uint32_t>(part.nodes.size());
    part.nodes[task.node].first_child = first;
    const unsigned level = part.nodes[task.node].level + 1;
    part.nodes.resize(first + children_);
    for (unsigned place = 0; place < children_; ++place) {
      const unsigned c = curve_.child(task.state, place);
      TreeNode& child = part.nodes[first + c];
      child.first_point = borders[place];
      child.count = borders[place + 1] - borders[place];
      child.level = level;
      divide(part, {first + c, curve_.next(task.state, place), child_cell(task.cell, c), std::move(lists[c])}, later);
    }
  }

  /// Puts the parts in the places of the top's nodes that they grew from.
  void join(Part& top, std::vector<Part>& parts) {
    std::vector<std::size_t> first_node(parts.size()), first_extra(parts.size());
    std::size_t nodes = top.nodes.size(), extra = top.extra.size();
    tree_.depth = top.depth;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      first_node[p] = nodes - 1; // its root has a place already
      first_extra[p] = extra;
      nodes += parts[p].nodes.size() - 1;
      extra += parts[p].extra.size();
      tree_.depth = std::max(tree_.depth, parts[p].depth);
    }
    if (std::max(nodes, extra) >= std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("octree: the tree outgrows 32-bit addresses; raise the leaf capacity");
    tree_.nodes = std::move(top.nodes);
    tree_.nodes.resize(nodes);
    tree_.extra.resize(extra);
    std::copy(top.extra.begin(), top.extra.end(), tree_.extra.begin());
    parallel_ranges(parts.size(), 1, [&](std::size_t p, std::size_t) {
      for (std::size_t i = 0; i < parts[p].nodes.size(); ++i) {
        TreeNode node = parts[p].nodes[i];
        if (node.first_child != 0) node.first_child += static_cast<std::uint32_t>(first_node[p]);
        node.first_extra += static_cast<std::uint32_t>(first_extra[p]);
        tree_.nodes[i == 0 ? parts[p].place : first_node[p] + i] = node;
      }
      std::copy(parts[p].extra.begin(), parts[p].extra.end(),
                tree_.extra.begin() + static_cast<std::ptrdiff_t>(first_extra[p]));
      parts[p] = {};
    });
  }

  TreeOptions options_;
  Curve curve_;
  unsigned children_;
  Tree tree_;
  Pool<KeyedIndex> items_;          ///< along the curve, as are splats_, half_ and slab_
  Pool<Splat> splats_;              ///< for Listing::overlaps only
  Pool<std::array<float, 3>> half_; ///< for Listing::overlaps only
  std::vector<Slab> slab_;          ///< of patches; empty where all splats are discs
};

} // namespace

Tree build_tree(View<Splat> splats, const TreeOptions& options, View<PatchBend> bends) {
  if (options.axis_bits < 1 || options.axis_bits > 2)
    throw std::invalid_argument("octree: N must be 2 or 4 (axis_bits 1 or 2)");
  if (options.max_depth > key_levels(options.axis_bits))
    throw std::invalid_argument("octree: max_depth must be at most " + std::to_string(key_levels(options.axis_bits)) +
                                " for this N");
  if (options.leaf_capacity < 1) throw std::invalid_argument("octree: leaf_capacity must be at least 1");
  if (splats.size >= std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("octree: too many splats for 32-bit addresses");
  return Builder(splats, options, bends).take();
}

} // namespace pointgi
