#pragma once
/// B = E + rho H(B), iterated to a residual (method.md section 4).
#include "fmm/solve/radiosity_operator.h"
#include <array>
#include <string>

namespace pointgi {

struct SolveOptions {
  /// Residual to reach, r = E + rho H(B) - B: the power of |r| over the power of E, and the mean of |r| / B over the
  /// area, by which dark rooms converge too; the larger of the two, and the worst of the colours.
  double tolerance = 1e-4;
  /// Sweeps of Jacobi's method before its rate is judged.
  unsigned first_sweeps = 8;
  /// Krylov takes over where Jacobi would need more sweeps than this.
  unsigned patient_sweeps = 12;
  bool krylov = true; ///< false: Jacobi alone, whatever its rate
  /// A scene that keeps more than this share of its light from bounce to bounce is reported as not converging: there a
  /// discretisation's error of 1 - largest_rate is all of the answer.
  double largest_rate = 0.9995;
  /// Applies of the operator, at most.
  unsigned most_applies = 20000;
};

enum class SolveEnd {
  converged,
  keeps_its_light, ///< closed with albedo near 1: radiosity grows without end
  stalled          ///< the residual stopped falling above the tolerance, or most_applies were made
};

struct Solution {
  std::vector<double> radiosity; ///< B [points x 3, W/m^2], tree order; the best there is when it did not converge
  SolveEnd end = SolveEnd::stalled;
  double residual = 0.0; ///< of `radiosity`, as SolveOptions::tolerance
  double rate = 0.0;     ///< share of the light that the last Jacobi sweep kept
  double settling = 0.0; ///< share of the residual that it left
  unsigned applies = 0;  ///< of the operator: what the time goes with
  unsigned sweeps = 0;   ///< of these, Jacobi's
  unsigned krylov_steps = 0;
  std::vector<double> history; ///< power of the residual over that of E after each Jacobi sweep
};

/// emission E [points x 3, W/m^2], albedo rho [points x 3, 0..1], area [points, any unit]; tree order, RGB. All sums
/// and the iteration are in double; beside what is given and returned it keeps one irradiance, and Krylov's vectors
/// where these are needed. Jacobi's
/// method first; where its residual falls slowly, Eigen's BiCGSTAB over the operator about the kept linearisation
/// point, and a sweep of Jacobi's after each, which moves the linearisation point and gives the residual. Ends in
/// bounded time, whatever the scene. Deterministic. Throws std::invalid_argument on sizes that differ and on options
/// out of range.
Solution solve_radiosity(RadiosityOperator& exchange, View<float> emission, View<float> albedo, View<float> area,
                         const SolveOptions& options);

/// What to tell people; empty when it converged.
std::string complaint_of(const Solution& solution);

} // namespace pointgi
