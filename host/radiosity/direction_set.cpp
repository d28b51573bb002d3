#include "host/radiosity/direction_set.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

DirectionSet stratified(unsigned count) {
  DirectionSet set{DirectionPattern::stratified, {}, std::vector<float>(count, 1.0f / static_cast<float>(count))};
  // Rings so many that their cells are about as wide as they are long: pi rings² = count.
  const auto rings = static_cast<unsigned>(std::max(1.0, std::round(std::sqrt(count / pi))));
  unsigned before = 0;
  for (unsigned ring = 0; ring < rings; ++ring) {
    // Cells up to the outer edge of this ring, as the disc's area grows.
    const double outer = static_cast<double>(ring + 1) / rings;
    const unsigned end =
        ring + 1 == rings ? count : std::max(before + 1, static_cast<unsigned>(std::lround(count * outer * outer)));
    const auto sectors = static_cast<float>(end - before);
    for (unsigned k = before; k < end; ++k)
      set.cells.push_back({static_cast<float>(before) / static_cast<float>(count), sectors / static_cast<float>(count),
                           static_cast<float>(k - before) / sectors, 1.0f / sectors});
    before = end;
  }
  return set;
}

/// Form factor of the rectangle [0, x] x [0, y] in the plane z = 1 with the differential area at 0 that faces it.
double top_corner(double x, double y) {
  const double p = std::sqrt(1.0 + x * x), q = std::sqrt(1.0 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2.0 * pi);
}

/// The same of x' in [0, x] at the heights z' > z in the plane y = 1.
double side_corner(double x, double z) {
  const double q = std::sqrt(1.0 + z * z);
  return std::atan(x / q) / q / (2.0 * pi);
}

DirectionSet hemicube(unsigned count) {
  DirectionSet set{DirectionPattern::hemicube, {}, {}};
  const int half = std::max(1, static_cast<int>(std::lround(std::sqrt(count / 12.0)))); // 3 (2 half)² cells
  const double step = 1.0 / half;
  const auto add = [&](double x, double y, double z, double weight) {
    const double length = std::sqrt(x * x + y * y + z * z);
    set.cells.push_back(
        {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length), 0.0f});
    set.weights.push_back(static_cast<float>(weight));
  };
  for (int i = -half; i < half; ++i)
    for (int j = -half; j < half; ++j) {
      const double x = i * step, y = j * step;
      add(x + step / 2, y + step / 2, 1.0,
          top_corner(x + step, y + step) - top_corner(x, y + step) - top_corner(x + step, y) + top_corner(x, y));
    }
  for (int side = 0; side < 4; ++side)
    for (int i = -half; i < half; ++i)
      for (int k = 0; k < half; ++k) {
        const double x = i * step, z = k * step, along = x + step / 2, sign = side % 2 == 0 ? 1.0 : -1.0;
        add(side < 2 ? along : sign, side < 2 ? sign : along, z + step / 2,
            side_corner(x + step, z) - side_corner(x, z) - side_corner(x + step, z + step) + side_corner(x, z + step));
      }
  return set;
}

} // namespace

DirectionSet direction_set(DirectionPattern pattern, unsigned count) {
  return pattern == DirectionPattern::hemicube ? hemicube(count) : stratified(count);
}

} // namespace pointgi
