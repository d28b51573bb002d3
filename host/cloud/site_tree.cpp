#include "host/cloud/site_tree.h"
#include "octree/parallel.h"
#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

namespace pointgi {

namespace {

constexpr std::uint32_t task_sites = 1 << 15; // ranges up to this size are divided by one thread
constexpr unsigned most_children = 8;

SiteTree::Box box_at(const SitePlace& p) {
  return {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
}

} // namespace

class SiteTree::Builder {
public:
  Builder(SiteTree& tree, const Pool<std::uint64_t>& keys) : tree_(tree), keys_(keys) {}

  void run() {
    Part top;
    top.entries.resize(1);
    std::vector<Task> tasks;
    divide(top, {0, 0, tree_.size()}, &tasks);
    std::vector<Part> parts(tasks.size());
    parallel_ranges(tasks.size(), 1, [&](std::size_t t, std::size_t) {
      parts[t].entries.resize(1);
      divide(parts[t], {0, tasks[t].begin, tasks[t].end}, nullptr);
    });
    join(top, tasks, parts);
  }

private:
  void divide(Part& part, const Task& task, std::vector<Task>* later) const {
    const std::uint32_t count = task.end - task.begin;
    if (later != nullptr && count <= task_sites) {
      later->push_back(task);
      return;
    }
    if (count <= leaf_size) {
      part.entries[task.entry] = {tree_.box_of(task.begin, task.end), task.begin, count | leaf_flag};
      part.leaf_begin.push_back(task.begin);
      return;
    }
    std::array<std::uint32_t, most_children + 1> borders;
    const unsigned children = child_borders(task, borders);
    const auto first = static_cast<std::uint32_t>(part.entries.size());
    part.entries.resize(first + children);
    for (unsigned c = 0; c < children; ++c)
      divide(part, {first + c, borders[c], borders[c + 1]}, later);
    part.entries[task.entry].first = first;
    part.entries[task.entry].count = children;
    if (later == nullptr) enclose_children(part.entries, task.entry);
  }

  /// Cuts where the highest digit of the keys changes that is not the same in all; equal keys into equal parts.
  unsigned child_borders(const Task& task, std::array<std::uint32_t, most_children + 1>& borders) const {
    const std::uint64_t differing = keys_[task.begin] ^ keys_[task.end - 1];
    unsigned children = 0;
    borders[0] = task.begin;
    if (differing == 0) {
      const std::uint32_t part = (task.end - task.begin + most_children - 1) / most_children;
      while (borders[children] < task.end) {
        borders[children + 1] = std::min(borders[children] + part, task.end);
        ++children;
      }
      return children;
    }
    unsigned shift = 0;
    while (differing >> shift >= most_children)
      shift += 3;
    while (borders[children] < task.end) {
      const std::uint64_t digits = keys_[borders[children]] >> shift;
      const auto past = std::partition_point(keys_.begin() + borders[children], keys_.begin() + task.end,
                                             [&](std::uint64_t key) { return key >> shift == digits; });
      borders[++children] = static_cast<std::uint32_t>(past - keys_.begin());
    }
    return children;
  }

  static void enclose_children(Pool<Entry>& entries, std::uint32_t index) {
    Entry& entry = entries[index];
    entry.box = entries[entry.first].box;
    for (std::uint32_t c = 1; c < entry.count; ++c)
      entry.box.add(entries[entry.first + c].box);
  }

  /// Puts the parts in the places of the top's entries that they grew from.
  void join(Part& top, const std::vector<Task>& tasks, std::vector<Part>& parts) {
    std::vector<std::size_t> first_entry(parts.size()), first_leaf(parts.size());
    std::size_t entries = top.entries.size(), leaves = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      first_entry[p] = entries - 1; // its root has a place already
      first_leaf[p] = leaves;
      entries += parts[p].entries.size() - 1;
      leaves += parts[p].leaf_begin.size();
    }
    tree_.entries_.resize(entries);
    tree_.leaf_begin_.resize(leaves + 1);
    tree_.leaf_begin_[leaves] = tree_.size();
    std::copy(top.entries.begin(), top.entries.end(), tree_.entries_.begin());
    parallel_ranges(parts.size(), 1, [&](std::size_t p, std::size_t) {
      for (std::size_t i = 0; i < parts[p].entries.size(); ++i) {
        Entry entry = parts[p].entries[i];
        if (!entry.is_leaf()) entry.first += static_cast<std::uint32_t>(first_entry[p]);
        tree_.entries_[i == 0 ? tasks[p].entry : first_entry[p] + i] = entry;
      }
      std::copy(parts[p].leaf_begin.begin(), parts[p].leaf_begin.end(),
                tree_.leaf_begin_.begin() + static_cast<std::ptrdiff_t>(first_leaf[p]));
      parts[p] = {};
    });
    for (std::size_t i = top.entries.size(); i-- > 0;) // children stand behind their parents
      if (!tree_.entries_[i].is_leaf()) enclose_children(tree_.entries_, static_cast<std::uint32_t>(i));
  }

  SiteTree& tree_;
  const Pool<std::uint64_t>& keys_;
};

/// Collects the nearest places of one, sorted by (distance, site).
class SiteTree::Nearest {
public:
  Nearest(const SiteTree& tree, const SitePlace& at, unsigned k, std::uint32_t without, Neighbour* out)
      : tree_(tree), at_(at), box_(box_at(at)), k_(k), without_(without), out_(out) {}

  unsigned count() const { return count_; }

  void visit(const Entry& entry) {
    if (entry.is_leaf()) {
      const SitePlaces& p = tree_.places_;
      std::array<float, leaf_size> distance2;
      measure(&p.x[entry.first], &p.y[entry.first], &p.z[entry.first], entry.size(), at_, distance2.data());
      for (std::uint32_t i = 0; i < entry.size(); ++i)
        consider({entry.first + i, distance2[i]});
      return;
    }
    struct Way {
      float distance2;
      std::uint32_t entry;
    };
    std::array<Way, most_children> ways;
    for (unsigned c = 0; c < entry.count; ++c) { // the nearest child first
      const Way way{tree_.entries_[entry.first + c].box.distance2(box_), entry.first + c};
      unsigned at = c;
      for (; at > 0 && ways[at - 1].distance2 > way.distance2; --at)
        ways[at] = ways[at - 1];
      ways[at] = way;
    }
    for (unsigned w = 0; w < entry.count && ways[w].distance2 <= worst_; ++w)
      visit(tree_.entries_[ways[w].entry]);
  }

private:
  static bool before(const Neighbour& a, const Neighbour& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.site < b.site;
  }

  void consider(const Neighbour& found) {
    if (found.distance2 > worst_ || found.site == without_) return;
    if (count_ == k_ && !before(found, out_[k_ - 1])) return;
    unsigned at = count_ < k_ ? count_++ : k_ - 1;
    for (; at > 0 && before(found, out_[at - 1]); --at)
      out_[at] = out_[at - 1];
    out_[at] = found;
    if (count_ == k_) worst_ = out_[k_ - 1].distance2;
  }

  const SiteTree& tree_;
  SitePlace at_;
  Box box_;
  unsigned k_;
  std::uint32_t without_;
  Neighbour* out_;
  unsigned count_ = 0;
  float worst_ = std::numeric_limits<float>::max();
};

SiteTree::SiteTree(SitePlaces&& places, const Pool<std::uint64_t>& keys) : places_(std::move(places)) {
  static std::atomic<std::uint64_t> trees{0};
  id_ = ++trees;
  Builder(*this, keys).run();
}

unsigned SiteTree::nearest(const SitePlace& at, unsigned k, std::uint32_t without, Neighbour* out) const {
  if (k == 0) return 0;
  Nearest search(*this, at, k, without, out);
  search.visit(entries_[0]);
  return search.count();
}

std::uint32_t SiteTree::leaf_of(std::uint32_t site) const {
  const auto past = std::upper_bound(leaf_begin_.begin(), leaf_begin_.end() - 1, site);
  return static_cast<std::uint32_t>(past - leaf_begin_.begin()) - 1;
}

SiteTree::Box SiteTree::box_of(std::uint32_t begin, std::uint32_t end) const {
  Box box = box_at(places_[begin]);
  for (std::uint32_t site = begin + 1; site < end; ++site)
    box.add(box_at(places_[site]));
  return box;
}

} // namespace pointgi
