#pragma once
/// A shrub as a scan sees it: leaves turned any way round a stem, no normals.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace pointgi::test {

/// Lines "x y z r g b" of `count` points: a stem of 500, then leaves of 20 in one crown, which has more of them the
/// more points there are. A larger shrub begins with the points of a smaller one.
inline std::string shrub_text(std::size_t count) {
  constexpr std::size_t stem = 500, of_leaf = 20;
  constexpr double leaf_radius = 0.035;
  std::mt19937 numbers(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(numbers()) / 4294967296.0;
  };
  std::string text;
  const auto add = [&](double x, double y, double z, int red, int green, int blue) {
    char line[96];
    std::snprintf(line, sizeof line, "%.6f %.6f %.6f %d %d %d\n", x, y, z, red, green, blue);
    text += line;
  };
  for (std::size_t i = 0; i < std::min(stem, count); ++i) {
    const double phi = uniform(0.0, 6.2831853), y = uniform(0.0, 0.5);
    add(0.03 * std::cos(phi), y, 0.03 * std::sin(phi), 90, 70, 50);
  }
  double centre[3] = {}, u[3] = {}, v[3] = {};
  for (std::size_t i = stem; i < count; ++i) {
    if ((i - stem) % of_leaf == 0) {
      double length = 2.0;
      while (length > 1.0) { // in a ball
        for (double& c : centre)
          c = uniform(-1.0, 1.0);
        length = std::hypot(centre[0], centre[1], centre[2]);
      }
      const double z = uniform(-1.0, 1.0), phi = uniform(0.0, 6.2831853), s = std::sqrt(1.0 - z * z);
      const double normal[3] = {s * std::cos(phi), s * std::sin(phi), z};
      // Two directions across the normal.
      const int small = std::fabs(normal[0]) < 0.6 ? 0 : 1;
      double axis[3] = {};
      axis[small] = 1.0;
      const double across = normal[small], root = std::sqrt(1.0 - across * across);
      for (int a = 0; a < 3; ++a)
        u[a] = (axis[a] - across * normal[a]) / root;
      for (int a = 0; a < 3; ++a)
        v[a] = normal[(a + 1) % 3] * u[(a + 2) % 3] - normal[(a + 2) % 3] * u[(a + 1) % 3];
    }
    const double r = leaf_radius * std::sqrt(uniform(0.0, 1.0)), phi = uniform(0.0, 6.2831853);
    const double a = r * std::cos(phi), b = r * std::sin(phi);
    add(0.5 * centre[0] + a * u[0] + b * v[0], 0.9 + 0.5 * centre[1] + a * u[1] + b * v[1],
        0.5 * centre[2] + a * u[2] + b * v[2], 60, 120, 40);
  }
  return text;
}

} // namespace pointgi::test
