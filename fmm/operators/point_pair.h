#pragma once
/// What one splat gives another: near links and the direct sum.
#include "octree/splat.h"
#include "shared/fmm_types.h"
#include <Eigen/Core>
#include <cmath>

namespace pointgi {

/// A splat of the tree in double.
struct ExchangePoint {
  Eigen::Vector3d x{0, 0, 0}, n{0, 0, 1}; ///< position, unit normal
  double area = 0.0;                      ///< effective area A

  ExchangePoint() = default;
  explicit ExchangePoint(const Splat& s)
      : x(s.position[0], s.position[1], s.position[2]), n(s.normal[0], s.normal[1], s.normal[2]), area(s.area) {}
};

/// Two unit vectors perpendicular to the unit vector n and to each other (Duff et al. 2017).
inline void tangents(const Eigen::Vector3d& n, Eigen::Vector3d& u, Eigen::Vector3d& v) {
  const double sign = n.z() < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + n.z()), b = n.x() * n.y() * a;
  u = {1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
  v = {b, sign + n.y() * n.y() * a, -n.y()};
}

/// F such that H = F B is the irradiance at x_i [per unit radiosity of the splat j], both clamps, nothing between:
///   A_j [n_i.r]+ [-n_j.r]+ / (pi |r|^4),  r = x_j - x_i     (method.md section 4)
/// and where |r|^2 < FMM_CLOSE A_j the sum over four quarters of the splat's disc, a rule of degree 3 at 1/sqrt(2) of
/// its radius. As a single point the neighbour across an edge counts 67 % too much, and the wall that it belongs to,
/// seen from d spacings, 1/(24 d^2) too much (23 % at 1/2); with four the rows along a cube's edges are right to 0.3 %,
/// which a furnace of albedo 0.99 needs. A quarter nearer than its own diameter has, as a disc seen from its axis,
/// |r|^2 + R^2 for |r|^2, fading out at |r| = 2 R: F stays below 1 when splats touch. Coincident points, and a point
/// with itself, give 0.
inline double point_exchange(const ExchangePoint& i, const ExchangePoint& j) {
  constexpr double inverse_pi = 0.31830988618379067154;
  const Eigen::Vector3d r = j.x - i.x;
  const double r2 = r.squaredNorm();
  if (r2 >= static_cast<double>(FMM_CLOSE) * j.area) {
    const double a = i.n.dot(r), b = -j.n.dot(r);
    return a > 0.0 && b > 0.0 ? j.area * inverse_pi * a * b / (r2 * r2) : 0.0;
  }
  const double b = -j.n.dot(r); // of all four quarters: they lie in its plane
  if (!(b > 0.0)) return 0.0;
  Eigen::Vector3d u, v;
  tangents(j.n, u, v);
  const double quarter = 0.25 * j.area, disc2 = quarter * inverse_pi; // R^2 of a quarter as a disc
  const double offset = std::sqrt(2.0 * disc2);                       // the whole disc's radius, 2 R, over sqrt(2)
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d s = r + (k & 1 ? -offset : offset) * (k & 2 ? v : u);
    const double a = i.n.dot(s), s2 = s.squaredNorm();
    if (!(a > 0.0)) continue;
    const double fade = std::max(0.0, 1.0 - s2 / (4.0 * disc2));
    sum += a * b / (s2 * (s2 + disc2 * fade * fade));
  }
  return quarter * inverse_pi * sum;
}

} // namespace pointgi
