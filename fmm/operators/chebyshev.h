#pragma once
/// Interpolation on Chebyshev nodes of the first kind (Fong and Darve 2009, eq. 2.3).
#include <cmath>

namespace pointgi {

/// Node m of n in [-1, 1], m < n.
inline double chebyshev_node(unsigned n, unsigned m) {
  constexpr double pi = 3.14159265358979323846;
  return std::cos(pi * (2.0 * m + 1.0) / (2.0 * n));
}

/// weights[m], m < n: how much the value at node m counts at t in [-1, 1]. They sum to 1.
inline void chebyshev_weights(unsigned n, double t, double* weights) {
  for (unsigned m = 0; m < n; ++m) {
    const double u = chebyshev_node(n, m);
    double before_t = 1.0, at_t = t, before_u = 1.0, at_u = u, sum = 0.0;
    for (unsigned k = 1; k < n; ++k) {
      sum += at_t * at_u;
      const double next_t = 2.0 * t * at_t - before_t, next_u = 2.0 * u * at_u - before_u;
      before_t = at_t, at_t = next_t;
      before_u = at_u, at_u = next_u;
    }
    weights[m] = (1.0 + 2.0 * sum) / n;
  }
}

} // namespace pointgi
