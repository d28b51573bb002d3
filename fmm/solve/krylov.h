#pragma once
/// Eigen's BiCGSTAB over a radiosity operator.
#include "fmm/solve/radiosity_operator.h"

namespace pointgi {

struct KrylovResult {
  unsigned steps = 0;
  unsigned applies = 0;
  bool useful = false; ///< finite and nearer to the solution than the guess
};

/// Improves x, a solution of (I - rho H) x = emission about the kept linearisation point. Stops at |residual| <=
/// tolerance |emission| or after most_steps of two applies each. `x` is left as it was unless the result is useful.
KrylovResult solve_krylov(RadiosityOperator& exchange, View<float> emission, View<float> albedo, double tolerance,
                          unsigned most_steps, std::vector<double>& x);

} // namespace pointgi
