#pragma once
/// A closed room with a bumpy body in it, in the root cube: what the V-map and what stands on it is measured on.
#include "tests/support/clouds.h"
#include <algorithm>
#include <array>

namespace pointgi::test {

namespace detail {

/// In the unit of the room, whose walls are at -1 and 1; the root cube's is 0.4 of it about 0.5.
inline Splat room_splat(const std::array<double, 3>& p, const std::array<double, 3>& n, double area) {
  const auto place = [&](int a) { return static_cast<float>(0.5 + 0.4 * p[a]); };
  const auto towards = [&](int a) { return static_cast<float>(n[a]); };
  // Discs a little larger than the squares that they stand for overlap without gaps.
  Splat s = make_splat(place(0), place(1), place(2), towards(0), towards(1), towards(2),
                       static_cast<float>(0.4 * 1.1 * std::sqrt(area)));
  s.area = static_cast<float>(0.16 * area);
  return s;
}

inline std::array<double, 3> bumpy(const std::array<double, 3>& d) {
  const double l = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  const double r = 0.45 * (1.0 + 0.12 * std::sin(7.0 * d[0] / l) * std::sin(6.0 * d[1] / l) * std::sin(8.0 * d[2] / l));
  return {r * d[0] / l, r * d[1] / l, r * d[2] / l};
}

} // namespace detail

/// About `count` splats: three quarters on the walls, facing inwards, at random places of a grid's squares, the rest on
/// a body with bumps of an eighth of its size.
inline std::vector<Splat> room_splats(std::size_t count, unsigned seed = 1) {
  using V = std::array<double, 3>;
  std::vector<Splat> splats;
  std::mt19937 g(seed);
  std::uniform_real_distribution<double> inside(0.0, 1.0);
  const std::size_t body = count / 4;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(count - body) / 6.0));
  const double h = 2.0 / side;
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const int axis = face / 2;
        V p{}, n{};
        p[axis] = face % 2 == 1 ? 1.0 : -1.0;
        n[axis] = -p[axis];
        p[(axis + 1) % 3] = -1.0 + h * (i + inside(g));
        p[(axis + 2) % 3] = -1.0 + h * (j + inside(g));
        splats.push_back(detail::room_splat(p, n, h * h));
      }
  const double pi = 3.14159265358979, golden = pi * (3.0 - std::sqrt(5.0));
  for (std::size_t k = 0; k < body; ++k) {
    const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(body);
    const double s = std::sqrt(1.0 - z * z), angle = golden * static_cast<double>(k);
    const V d{s * std::cos(angle), s * std::sin(angle), z};
    // Differences along two tangents give the normal and the surface that the point stands for.
    const V u = std::fabs(z) < 0.9 ? V{d[1], -d[0], 0.0} : V{0.0, d[2], -d[1]};
    const double lu = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    const V t{u[0] / lu, u[1] / lu, u[2] / lu};
    const V b{d[1] * t[2] - d[2] * t[1], d[2] * t[0] - d[0] * t[2], d[0] * t[1] - d[1] * t[0]};
    const auto slope = [&](const V& along) {
      const double e = 1e-4;
      V plus, minus;
      for (int a = 0; a < 3; ++a) {
        plus[a] = d[a] + e * along[a];
        minus[a] = d[a] - e * along[a];
      }
      plus = detail::bumpy(plus);
      minus = detail::bumpy(minus);
      return V{(plus[0] - minus[0]) / (2 * e), (plus[1] - minus[1]) / (2 * e), (plus[2] - minus[2]) / (2 * e)};
    };
    const V x = slope(t), y = slope(b);
    V n{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
    const double stretch = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (n[0] * d[0] + n[1] * d[1] + n[2] * d[2] < 0.0)
      for (double& c : n)
        c = -c;
    V p = detail::bumpy(d);
    p[2] -= 0.4;
    splats.push_back(detail::room_splat(p, n, 4.0 * pi / static_cast<double>(body) * stretch));
  }
  return splats;
}

/// A radiosity that varies smoothly over the room, of about 0.1 to 1, for each splat.
inline std::vector<double> room_radiosity(View<Splat> splats) {
  std::vector<double> b;
  b.reserve(splats.size);
  for (const Splat& s : splats)
    b.push_back(0.5 + 0.3 * std::sin(8.0 * s.position[0] + s.normal[1]) * std::cos(5.0 * s.position[2]) +
                (s.normal[0] > 0.9f ? 0.2 : 0.0));
  return b;
}

} // namespace pointgi::test
