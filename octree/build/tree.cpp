#include "octree/build/tree.h"
#include "octree/build/cell_key.h"
#include "octree/build/disc_cell.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

namespace pointgi {

namespace {

/// What one more cell on a ray's way costs, in splat tests: the descent from the root and the exit plane.
/// Found by rendering the test clouds with 2, 4, 8 and 16; flat around this value.
constexpr double step_cost = 4.0;

class Builder {
public:
  Builder(View<Splat> splats, const TreeOptions& options) : options_(options) {
    children_ = 1u << (3 * options.axis_bits);
    tree_.options = options;
    sort_along_curve(splats);
    tree_.nodes.emplace_back();
    tree_.nodes[0].count = static_cast<std::uint32_t>(splats.size);
    divide(0, Cell{{0.0f, 0.0f, 0.0f}, 1.0f}, {});
  }

  Tree take() { return std::move(tree_); }

private:
  using Lists = std::vector<std::vector<std::uint32_t>>;

  void sort_along_curve(View<Splat> splats) {
    struct Entry {
      std::uint64_t key;
      std::uint32_t index;
    };
    std::vector<Entry> entries(splats.size);
    for (std::size_t i = 0; i < splats.size; ++i)
      entries[i] = {cell_key(cell_of(splats[i].position), options_.axis_bits), static_cast<std::uint32_t>(i)};
    // The index breaks ties, so that coincident points keep one order on every machine.
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
    keys_.resize(splats.size);
    splats_.resize(splats.size);
    half_.resize(splats.size);
    tree_.order.resize(splats.size);
    for (std::size_t k = 0; k < splats.size; ++k) {
      keys_[k] = entries[k].key;
      tree_.order[k] = entries[k].index;
      splats_[k] = splats[entries[k].index];
      disc_half_extents(splats_[k], half_[k].data());
    }
  }

  /// First own point of each child, and one past the last; the keys are sorted, so each border is a binary search.
  std::vector<std::uint32_t> child_borders(const TreeNode& node) const {
    const unsigned shift = 3 * options_.axis_bits * (key_levels(options_.axis_bits) - 1 - node.level);
    std::vector<std::uint32_t> borders(children_ + 1);
    const auto begin = keys_.begin() + node.first_point, end = begin + node.count;
    for (unsigned c = 0; c < children_; ++c) {
      const auto at = std::partition_point(
          begin, end, [&](std::uint64_t key) { return static_cast<unsigned>((key >> shift) & (children_ - 1)) < c; });
      borders[c] = static_cast<std::uint32_t>(at - keys_.begin());
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
    int from[3], to[3];
    for (int a = 0; a < 3; ++a) {
      const float centre = splats_[point].position[a] - cell.low[a], reach = half_[point][a] + cell_margin;
      from[a] = std::clamp(static_cast<int>(std::floor((centre - reach) / side)), 0, n - 1);
      to[a] = std::clamp(static_cast<int>(std::floor((centre + reach) / side)), 0, n - 1);
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) {
          const unsigned child = static_cast<unsigned>(x + n * (y + n * z));
          if (child != owner && disc_touches_cell(splats_[point], half_[point].data(), child_cell(cell, child)))
            lists[child].push_back(point);
        }
  }

  /// Expected splat tests of a ray that enters the cell, after dividing it: a child is met with the share that its
  /// faces have of the cell's, 1/N² (the surface-area heuristic).
  bool dividing_pays(std::size_t listed, const std::vector<std::uint32_t>& borders, const Lists& lists) const {
    double after = 0.0;
    for (unsigned c = 0; c < children_; ++c) {
      const std::size_t child = borders[c + 1] - borders[c] + lists[c].size();
      after += static_cast<double>(child) + step_cost;
    }
    const double n = 1u << options_.axis_bits;
    return after / (n * n) < static_cast<double>(listed) + step_cost;
  }

  void divide(std::uint32_t index, const Cell& cell, const std::vector<std::uint32_t>& extra) {
    const TreeNode node = tree_.nodes[index];
    tree_.depth = std::max(tree_.depth, node.level);
    const std::size_t listed = node.count + extra.size();
    if (listed > options_.leaf_capacity && node.level < options_.max_depth) {
      const std::vector<std::uint32_t> borders = child_borders(node);
      Lists lists(children_);
      if (options_.listing == Listing::centres) {
        add_children(index, node, cell, borders, lists);
        return;
      }
      for (unsigned c = 0; c < children_; ++c)
        for (std::uint32_t p = borders[c]; p < borders[c + 1]; ++p)
          list_in_children(p, c, cell, lists);
      for (std::uint32_t p : extra)
        list_in_children(p, children_, cell, lists);
      if (dividing_pays(listed, borders, lists)) {
        add_children(index, node, cell, borders, lists);
        return;
      }
    }
    tree_.nodes[index].first_extra = static_cast<std::uint32_t>(tree_.extra.size());
    tree_.nodes[index].extra_count = static_cast<std::uint32_t>(extra.size());
    tree_.extra.insert(tree_.extra.end(), extra.begin(), extra.end());
  }

  void add_children(std::uint32_t index, const TreeNode& node, const Cell& cell,
                    const std::vector<std::uint32_t>& borders, Lists& lists) {
    const std::size_t first = tree_.nodes.size();
    tree_.nodes[index].first_child = static_cast<std::uint32_t>(first);
    tree_.nodes.resize(first + children_);
    for (unsigned c = 0; c < children_; ++c) {
      TreeNode& child = tree_.nodes[first + c];
      child.first_point = borders[c];
      child.count = borders[c + 1] - borders[c];
      child.level = node.level + 1;
    }
    for (unsigned c = 0; c < children_; ++c) {
      divide(static_cast<std::uint32_t>(first + c), child_cell(cell, c), lists[c]);
      lists[c] = {}; // what a finished child listed is not needed while its siblings are divided
    }
  }

  TreeOptions options_;
  unsigned children_ = 8;
  Tree tree_;
  std::vector<std::uint64_t> keys_; ///< in tree order, as are splats_ and half_
  std::vector<Splat> splats_;
  std::vector<std::array<float, 3>> half_;
};

} // namespace

Tree build_tree(View<Splat> splats, const TreeOptions& options) {
  if (options.axis_bits < 1 || options.axis_bits > 2)
    throw std::invalid_argument("octree: N must be 2 or 4 (axis_bits 1 or 2)");
  if (options.max_depth > key_levels(options.axis_bits))
    throw std::invalid_argument("octree: max_depth must be at most " + std::to_string(key_levels(options.axis_bits)) +
                                " for this N");
  if (options.leaf_capacity < 1) throw std::invalid_argument("octree: leaf_capacity must be at least 1");
  if (splats.size >= std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("octree: too many splats for 32-bit addresses");
  return Builder(splats, options).take();
}

} // namespace pointgi
