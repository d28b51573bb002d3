#include "host/scene/merge_coincident.h"
#include "octree/build/cell_key.h"
#include "octree/build/key_sort.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace pointgi {

namespace {

constexpr float alike_cosine = 0.5f;
constexpr std::size_t most_alone = 16; // in one place

/// Order by place and material; equal ones keep their order.
bool before(const Splat& a, const Splat& b) {
  if (const int c = std::memcmp(a.position, b.position, sizeof a.position); c != 0) return c < 0;
  return a.material < b.material;
}

bool alike(const Splat& a, const Splat& b) {
  return a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] + a.normal[2] * b.normal[2] > alike_cosine;
}

/// `ends`: one of them ends at a border, and is a side of a sheet only where they fit exactly.
bool opposite(const Splat& a, const Splat& b, bool ends) {
  const float opposite_cosine = ends ? -0.999f : -0.9f;
  return a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] + a.normal[2] * b.normal[2] < opposite_cosine;
}

/// From indices before the splats that are `gone` go to those after, ascending.
void renumber(std::vector<CoincidentSides>& pairs, const std::vector<bool>& gone) {
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.one < b.one; });
  std::vector<std::uint32_t> number(pairs.empty() ? 0 : gone.size());
  for (std::uint32_t i = 0, kept = 0; i < number.size(); ++i)
    number[i] = gone[i] ? 0 : kept++;
  for (CoincidentSides& pair : pairs)
    pair = {number[pair.one], number[pair.other]};
}

/// What a group of merged splats sums up to.
struct Sum {
  Splat first;
  double normal[3] = {0, 0, 0}, colour[3] = {0, 0, 0}, area = 0;
  std::size_t count = 0;

  void add(const Splat& s) {
    for (int k = 0; k < 3; ++k) {
      normal[k] += s.normal[k];
      colour[k] += s.colour[k];
    }
    area += s.area;
    first.radius = std::max(first.radius, s.radius);
    ++count;
  }

  Splat mean() const {
    if (count == 1) return first;
    Splat s = first;
    const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int k = 0; k < 3; ++k) {
      s.normal[k] = static_cast<float>(normal[k] / length); // alike within 60 degrees of the first: never zero
      s.colour[k] = static_cast<float>(colour[k] / static_cast<double>(count));
    }
    s.area = static_cast<float>(area);
    return s;
  }
};

bool same_place(const Splat& a, const Splat& b) {
  return std::memcmp(a.position, b.position, sizeof a.position) == 0 && a.material == b.material;
}

/// Splats that share place and material: groups of two and more, one behind the other.
struct Groups {
  std::vector<std::uint32_t> member;
  std::vector<std::size_t> end; ///< of each group, in `member`

  /// Those among splats in one cell of the curve.
  void add_cell(const std::vector<Splat>& splats, std::vector<std::uint32_t>& cell) {
    std::sort(cell.begin(), cell.end(), [&](std::uint32_t a, std::uint32_t b) {
      return before(splats[a], splats[b]) || (!before(splats[b], splats[a]) && a < b);
    });
    for (std::size_t i = 0, past = 0; i < cell.size(); i = past) {
      for (past = i + 1; past < cell.size() && same_place(splats[cell[i]], splats[cell[past]]);)
        ++past;
      if (past == i + 1) continue;
      member.insert(member.end(), cell.begin() + static_cast<std::ptrdiff_t>(i),
                    cell.begin() + static_cast<std::ptrdiff_t>(past));
      end.push_back(member.size());
    }
  }
  void add(const Groups& other) {
    for (const std::size_t past : other.end)
      end.push_back(member.size() + past);
    member.insert(member.end(), other.member.begin(), other.member.end());
  }
};

/// Found in cells along a curve, which are sorted by their digits: only what is in the same cell is compared.
Groups coincident_groups(const std::vector<Splat>& splats) {
  constexpr std::size_t grain = 1 << 14;
  Pool<KeyedIndex> items(splats.size());
  parallel_ranges(items.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      items[i] = {morton_key(cell_of(splats[i].position)), static_cast<std::uint32_t>(i)};
  });
  sort_by_key(items);
  const std::vector<std::size_t> cuts =
      cuts_between_keys(items.size(), grain, [&](std::size_t i) { return items[i].key; });
  std::vector<Groups> found(cuts.size() - 1);
  parallel_ranges(found.size(), 1, [&](std::size_t range, std::size_t) {
    std::vector<std::uint32_t> cell;
    for (std::size_t i = cuts[range], past; i < cuts[range + 1]; i = past) {
      for (past = i + 1; past < cuts[range + 1] && items[past].key == items[i].key;)
        ++past;
      if (past == i + 1) continue;
      cell.clear();
      for (std::size_t k = i; k < past; ++k)
        cell.push_back(items[k].index);
      found[range].add_cell(splats, cell);
    }
  });
  Groups all;
  for (const Groups& groups : found)
    all.add(groups);
  return all;
}

} // namespace

std::vector<MergedSplat> merge_coincident(std::vector<Splat>& splats, std::vector<std::uint32_t>& id,
                                          std::vector<CoincidentSides>* pairs, const std::vector<bool>& alone) {
  const Groups groups = coincident_groups(splats);
  if (groups.end.empty()) return {};
  std::vector<bool> gone(splats.size(), false);
  std::vector<MergedSplat> merged;
  for (std::size_t group = 0, begin = 0; group < groups.end.size(); begin = groups.end[group++]) {
    std::vector<std::pair<std::uint32_t, Sum>> sides; // a few: fronts, backs, the faces at a corner
    for (std::size_t k = begin; k < groups.end[group]; ++k) {
      const std::uint32_t index = groups.member[k];
      const Splat& s = splats[index];
      const auto is_alone = [&](std::uint32_t splat) {
        return !alone.empty() && sides.size() < most_alone && alone[id[splat]];
      };
      auto side = std::find_if(sides.begin(), sides.end(), [&](const auto& other) {
        return alike(other.second.first, s) && !is_alone(index) && !is_alone(other.first);
      });
      if (side == sides.end()) {
        sides.push_back({index, Sum{s}});
        side = sides.end() - 1;
      } else {
        gone[index] = true;
        merged.push_back({id[index], id[side->first]});
      }
      side->second.add(s);
    }
    for (const auto& [first, sum] : sides)
      splats[first] = sum.mean();
    if (pairs != nullptr && sides.size() == 2 &&
        opposite(splats[sides[0].first], splats[sides[1].first],
                 !alone.empty() && (alone[id[sides[0].first]] || alone[id[sides[1].first]])))
      pairs->push_back({sides[0].first, sides[1].first});
  }
  if (pairs != nullptr) renumber(*pairs, gone);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < splats.size(); ++i)
    if (!gone[i]) {
      splats[kept] = splats[i];
      id[kept++] = id[i];
    }
  splats.resize(kept);
  id.resize(kept);
  return merged;
}

} // namespace pointgi
