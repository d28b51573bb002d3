#include "host/radiosity/point_blocks.h"
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <tuple>

namespace pointgi {

namespace {

/// Normals that differ by 1 are as far apart as places that differ by so many radii. In a room blocks of 16 that face
/// one way are four or five radii wide.
constexpr float radii_of_a_normal = 10.0f;

constexpr int axes = 6; ///< of positions, then of normals

class Blocks {
public:
  Blocks(View<Splat> points, std::vector<std::uint32_t>& places, std::size_t size)
      : points_(points), places_(places), size_(size) {
    double radii = 0.0;
    for (const std::uint32_t p : places)
      radii += double{points[p].radius};
    normal_scale_ =
        places.empty() ? 0.0f : radii_of_a_normal * static_cast<float>(radii / static_cast<double>(places.size()));
  }

  void run() {
    std::vector<Range> parts{{0, places_.size()}}; // halved at a time, until there is one for every thread
    while (std::any_of(parts.begin(), parts.end(),
                       [&](const Range& part) { return part.size() > std::max(task, size_); })) {
      std::vector<std::size_t> middle(parts.size());
      parallel_ranges(parts.size(), 1, [&](std::size_t k, std::size_t) { middle[k] = halve(parts[k]); });
      std::vector<Range> halves;
      for (std::size_t k = 0; k < parts.size(); ++k) {
        halves.push_back({parts[k].begin, middle[k]});
        if (middle[k] < parts[k].end) halves.push_back({middle[k], parts[k].end});
      }
      parts = std::move(halves);
    }
    parallel_ranges(parts.size(), 1, [&](std::size_t k, std::size_t) { split(parts[k]); });
  }

private:
  /// Begins at a multiple of the size.
  struct Range {
    std::size_t begin, end;
    std::size_t size() const { return end - begin; }
  };
  static constexpr std::size_t task = 1 << 15; ///< points that one thread splits down to blocks

  std::vector<std::uint32_t>::iterator at(std::size_t i) const {
    return places_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  /// Where the second half begins; the end of a range of one block, which is sorted.
  std::size_t halve(const Range& range) const {
    if (range.size() <= size_) {
      std::sort(at(range.begin), at(range.end));
      return range.end;
    }
    const int axis = longest_axis(range);
    const std::size_t blocks = (range.size() + size_ - 1) / size_, middle = range.begin + blocks / 2 * size_;
    std::nth_element(at(range.begin), at(middle), at(range.end), [&](std::uint32_t a, std::uint32_t b) {
      return std::make_tuple(coordinate(a, axis), a) < std::make_tuple(coordinate(b, axis), b);
    });
    return middle;
  }

  void split(const Range& range) const {
    const std::size_t middle = halve(range);
    if (middle == range.end) return;
    split({range.begin, middle});
    split({middle, range.end});
  }

  float coordinate(std::uint32_t place, int axis) const {
    const Splat& s = points_[place];
    return axis < 3 ? s.position[axis] : normal_scale_ * s.normal[axis - 3];
  }

  int longest_axis(const Range& range) const {
    std::array<float, axes> length;
    for (int a = 0; a < axes; ++a) {
      float low = coordinate(places_[range.begin], a), high = low;
      for (std::size_t i = range.begin; i < range.end; ++i) {
        low = std::min(low, coordinate(places_[i], a));
        high = std::max(high, coordinate(places_[i], a));
      }
      length[static_cast<std::size_t>(a)] = high - low;
    }
    return static_cast<int>(std::max_element(length.begin(), length.end()) - length.begin());
  }

  View<Splat> points_;
  std::vector<std::uint32_t>& places_;
  std::size_t size_;
  float normal_scale_;
};

} // namespace

std::vector<std::uint32_t> in_blocks(View<Splat> points, std::vector<std::uint32_t> places, std::size_t size) {
  Blocks(points, places, size).run();
  return places;
}

} // namespace pointgi
