#pragma once
/// Surfaces that exchange light with nothing between, and the links of such scenes.
#include "octree/vmap/links.h"
#include "tests/support/clouds.h"
#include <algorithm>
#include <array>

namespace pointgi::test {

/// An equal-area splat; facing (nx, ny, nz).
inline Splat area_splat(double x, double y, double z, double nx, double ny, double nz, double area) {
  Splat s = make_splat(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(nx),
                       static_cast<float>(ny), static_cast<float>(nz), static_cast<float>(0.7 * std::sqrt(area)));
  s.area = static_cast<float>(area);
  return s;
}

/// The inside of a sphere about (0.5, 0.5, 0.5).
inline std::vector<Splat> inside_sphere(std::size_t count, double radius = 0.4) {
  std::vector<Splat> splats = sphere_splats(count, static_cast<float>(radius));
  for (Splat& s : splats) {
    for (float& n : s.normal)
      n = -n;
    s.area = static_cast<float>(4.0 * 3.14159265358979 * radius * radius / static_cast<double>(count));
  }
  return splats;
}

/// A parallelogram `per_side` x `per_side`.
inline void add_quad(std::vector<Splat>& splats, int per_side, std::array<double, 3> corner, std::array<double, 3> u,
                     std::array<double, 3> v, std::array<double, 3> normal, double area) {
  for (int i = 0; i < per_side; ++i)
    for (int j = 0; j < per_side; ++j) {
      double p[3];
      for (int a = 0; a < 3; ++a)
        p[a] = corner[a] + u[a] * (i + 0.5) / per_side + v[a] * (j + 0.5) / per_side;
      splats.push_back(area_splat(p[0], p[1], p[2], normal[0], normal[1], normal[2], area / (per_side * per_side)));
    }
}

/// The inside of a cube of this side: faces x = low, x = high, y = low ..., each per_side^2 splats.
inline std::vector<Splat> inside_cube(int per_side, double side = 0.8) {
  std::vector<Splat> splats;
  const double low = 0.5 - side / 2;
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end) {
      std::array<double, 3> corner{low, low, low}, u{}, v{}, n{};
      corner[axis] += end * side;
      u[(axis + 1) % 3] = v[(axis + 2) % 3] = side;
      n[axis] = end == 0 ? 1.0 : -1.0;
      add_quad(splats, per_side, corner, u, v, n, side * side);
    }
  return splats;
}

/// Two square sheets that face each other, `gap` apart, askew to each other.
inline std::vector<Splat> facing_sheets(int per_side, double gap = 0.2) {
  std::vector<Splat> splats;
  add_quad(splats, per_side, {0.1, 0.1, 0.4}, {0.8, 0.0, 0.0}, {0.0, 0.8, 0.0}, {0.0, 0.0, 1.0}, 0.64);
  add_quad(splats, per_side, {0.12, 0.1, 0.4 + gap}, {0.75, 0.0, 0.0}, {0.0, 0.7, 0.0}, {0.0, 0.0, -1.0}, 0.525);
  return splats;
}

/// Whether all points of b lie before all points of a: bounds only, so "no" may be wrong.
inline bool wholly_before(const Cluster& a, const Cluster& b) {
  if (!(a.cone < 1.5f)) return false;
  float lowest = -a.high_along, distance = a.radius + b.radius, square = 0.0f;
  for (int k = 0; k < 3; ++k) {
    lowest += a.axis[k] * (a.axis[k] > 0.0f ? b.low[k] : b.high[k]);
    square += (b.centre[k] - a.centre[k]) * (b.centre[k] - a.centre[k]);
  }
  distance += std::sqrt(square);
  return lowest * std::cos(a.cone) > distance * std::sin(a.cone);
}

/// Links that cover every pair of points exactly once: far where the radii together are below `separation` of the
/// distance and the clusters wholly face each other, all others near, between leaves.
inline std::vector<Link> links_without_visibility(const ClusterTree& tree, float separation = 0.55f) {
  std::vector<Link> links;
  std::vector<std::array<std::uint32_t, 2>> waiting{{0, 0}};
  while (!waiting.empty()) {
    const std::uint32_t ka = waiting.back()[0], kb = waiting.back()[1];
    waiting.pop_back();
    const Cluster &a = tree.nodes[ka], &b = tree.nodes[kb];
    float square = 0.0f;
    for (int k = 0; k < 3; ++k)
      square += (b.centre[k] - a.centre[k]) * (b.centre[k] - a.centre[k]);
    const std::uint32_t first = std::min(ka, kb), second = std::max(ka, kb);
    if (ka != kb && a.radius + b.radius < separation * std::sqrt(square) && wholly_before(a, b) && wholly_before(b, a))
      links.push_back({first, second, 1.0f, LinkKind::far});
    else if (a.child_count == 0 && b.child_count == 0)
      links.push_back({first, second, 1.0f, LinkKind::near_});
    else if (ka == kb)
      for (std::uint32_t i = a.first_child; i < a.first_child + a.child_count; ++i)
        for (std::uint32_t j = i; j < a.first_child + a.child_count; ++j)
          waiting.push_back({i, j});
    else if (b.child_count == 0 || (a.child_count != 0 && a.radius >= b.radius))
      for (std::uint32_t i = a.first_child; i < a.first_child + a.child_count; ++i)
        waiting.push_back({i, kb});
    else
      for (std::uint32_t j = b.first_child; j < b.first_child + b.child_count; ++j)
        waiting.push_back({ka, j});
  }
  return links;
}

/// A radiosity that varies over the points and differs between colours, [n x 3], in [0.2, 1].
inline std::vector<double> varied_radiosity(View<Splat> points) {
  std::vector<double> b;
  for (const Splat& s : points)
    for (int c = 0; c < 3; ++c)
      b.push_back(0.6 + 0.4 * std::sin(7.0 * s.position[c] + 3.0 * s.position[(c + 1) % 3] + c));
  return b;
}

/// |a - b| / |b|.
inline double relative_l2(View<double> a, View<double> b) {
  double difference = 0.0, all = 0.0;
  for (std::size_t k = 0; k < b.size; ++k) {
    difference += (a[k] - b[k]) * (a[k] - b[k]);
    all += b[k] * b[k];
  }
  return std::sqrt(difference / all);
}

} // namespace pointgi::test
