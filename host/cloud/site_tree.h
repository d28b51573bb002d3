#pragma once
/// The tree of boxes behind Sites: neighbours of one place, or of a leaf's sites together.
#include "octree/pool.h"
#include <array>
#include <cstddef>
#include <cstdint>

namespace pointgi {

struct Neighbour {
  std::uint32_t site;
  float distance2; ///< squared, local units
};

using SitePlace = std::array<float, 3>;

/// Coordinates apart from each other, as vector instructions take them.
struct SitePlaces {
  Pool<float> x, y, z;

  explicit SitePlaces(std::size_t count) : x(count), y(count), z(count) {}
  std::size_t size() const { return x.size(); }
  SitePlace operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const SitePlace& place) {
    x[i] = place[0];
    y[i] = place[1];
    z[i] = place[2];
  }
};

/// Squares are added in this order everywhere, so that every search sees the same distances.
inline float distance2(const SitePlace& a, const SitePlace& b) {
  const float dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
  return dx * dx + dy * dy + dz * dz;
}

/// Squared distances of `count` places from one.
inline void measure(const float* x, const float* y, const float* z, unsigned count, const SitePlace& from,
                    float* distance2) {
  for (unsigned i = 0; i < count; ++i) {
    const float dx = x[i] - from[0], dy = y[i] - from[1], dz = z[i] - from[2];
    distance2[i] = dx * dx + dy * dy + dz * dz;
  }
}

/// A tree over places that lie along a Morton curve. Leaves are ranges of them; boxes are those of the places inside.
class SiteTree {
public:
  static constexpr std::uint32_t leaf_size = 32;

  struct Box {
    float low[3], high[3];

    /// Squared distance of the nearest point of the other box. Subtraction, product and sum are monotonic in float too:
    /// no two places of the boxes are nearer than this, not by a rounding either.
    float distance2(const Box& other) const {
      float sum = 0.0f;
      for (int a = 0; a < 3; ++a) {
        const float below = low[a] - other.high[a], above = other.low[a] - high[a];
        const float gap = below > above ? (below > 0.0f ? below : 0.0f) : (above > 0.0f ? above : 0.0f);
        sum += gap * gap;
      }
      return sum;
    }
    void add(const Box& other) {
      for (int a = 0; a < 3; ++a) {
        low[a] = low[a] < other.low[a] ? low[a] : other.low[a];
        high[a] = high[a] > other.high[a] ? high[a] : other.high[a];
      }
    }
  };

  /// `keys`: the places' Morton keys, ascending; needed no longer afterwards.
  SiteTree(SitePlaces&& places, const Pool<std::uint64_t>& keys);

  /// No two trees of a run have the same; never 0.
  std::uint64_t id() const { return id_; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(places_.size()); }
  SitePlace place(std::uint32_t site) const { return places_[site]; }
  const SitePlaces& places() const { return places_; }

  /// The nearest k places but `without`, ordered by (distance, site), into `out`. Returns how many there are.
  unsigned nearest(const SitePlace& at, unsigned k, std::uint32_t without, Neighbour* out) const;

  std::uint32_t leaf_of(std::uint32_t site) const;
  std::uint32_t leaf_begin(std::uint32_t leaf) const { return leaf_begin_[leaf]; }
  std::uint32_t leaf_end(std::uint32_t leaf) const { return leaf_begin_[leaf + 1]; }
  Box leaf_box(std::uint32_t leaf) const { return box_of(leaf_begin(leaf), leaf_end(leaf)); }

  /// Calls visit(first, past) for ranges of sites, ascending, that hold all sites within `reach2` of the box; ends when
  /// it returns false, and returns false then.
  template <class Visit>
  bool visit_near(const Box& box, float reach2, const Visit& visit) const {
    return visit_near(entries_[0], box, reach2, visit);
  }

private:
  /// A leaf, or a range of entries that are its children.
  struct Entry {
    Box box;
    std::uint32_t first; ///< site, or entry
    std::uint32_t count; ///< of sites, | leaf_flag, or of entries
    bool is_leaf() const { return (count & leaf_flag) != 0; }
    std::uint32_t size() const { return count & ~leaf_flag; }
  };
  static constexpr std::uint32_t leaf_flag = 0x80000000u;

  /// A part of the tree with numbers of its own; entries[0] is its root.
  struct Part {
    Pool<Entry> entries;
    Pool<std::uint32_t> leaf_begin;
  };
  struct Task {
    std::uint32_t entry, begin, end;
  };
  class Builder;
  class Nearest;

  Box box_of(std::uint32_t begin, std::uint32_t end) const;

  template <class Visit>
  bool visit_near(const Entry& entry, const Box& box, float reach2, const Visit& visit) const {
    if (entry.is_leaf()) return visit(entry.first, entry.first + entry.size());
    for (std::uint32_t c = entry.first; c < entry.first + entry.count; ++c)
      if (entries_[c].box.distance2(box) <= reach2 && !visit_near(entries_[c], box, reach2, visit)) return false;
    return true;
  }

  std::uint64_t id_;
  SitePlaces places_;
  Pool<Entry> entries_;            ///< entries_[0] is the root
  Pool<std::uint32_t> leaf_begin_; ///< first site of each leaf, ascending; one more than there are leaves
};

} // namespace pointgi
