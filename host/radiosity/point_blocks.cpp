#include "host/radiosity/point_blocks.h"
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

  /// [begin, end): begin is a multiple of the size.
  void split(std::size_t begin, std::size_t end) {
    const auto at = [&](std::size_t i) { return places_.begin() + static_cast<std::ptrdiff_t>(i); };
    if (end - begin <= size_) {
      std::sort(at(begin), at(end));
      return;
    }
    const int axis = longest_axis(begin, end);
    const std::size_t blocks = (end - begin + size_ - 1) / size_, middle = begin + blocks / 2 * size_;
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      return std::make_tuple(coordinate(a, axis), a) < std::make_tuple(coordinate(b, axis), b);
    });
    split(begin, middle);
    split(middle, end);
  }

private:
  float coordinate(std::uint32_t place, int axis) const {
    const Splat& s = points_[place];
    return axis < 3 ? s.position[axis] : normal_scale_ * s.normal[axis - 3];
  }

  int longest_axis(std::size_t begin, std::size_t end) const {
    std::array<float, axes> length;
    for (int a = 0; a < axes; ++a) {
      float low = coordinate(places_[begin], a), high = low;
      for (std::size_t i = begin; i < end; ++i) {
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
  Blocks(points, places, size).split(0, places.size());
  return places;
}

} // namespace pointgi
