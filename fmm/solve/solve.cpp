#include "fmm/solve/solve.h"
#include "fmm/solve/krylov.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace pointgi {

namespace {

/// Steps of one call of Krylov's method, at most; a closed room of albedo 0.99 takes about ten.
constexpr unsigned most_krylov_steps = 100;

struct Problem {
  RadiosityOperator& exchange;
  View<float> emission, albedo, area;
  std::vector<double> irradiance = {}; ///< of the last sweep

  /// E + rho H, element k of [points x 3], of the irradiance of the last sweep.
  double next(std::size_t k) const { return double{emission[k]} + double{albedo[k]} * irradiance[k]; }

  /// Sum of area |x| over the points, per colour; x(k): element k of [points x 3].
  template <class Value>
  std::array<double, 3> power(const Value& x) const {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < area.size; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += double{area[i]} * std::abs(x(3 * i + c));
    return sum;
  }

  /// Mean over the area of |change| / after, of the worst colour: a dark room counts as much as the bright street
  /// before it. What is darker than `faintest` of the mean is not asked for.
  template <class Change, class After>
  double relative(const Change& change, const After& after) const {
    constexpr double faintest = 1e-5;
    const std::array<double, 3> all = power(after);
    double whole = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < area.size; ++i)
      whole += double{area[i]};
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (std::size_t i = 0; i < area.size; ++i) {
        const double by = change(3 * i + c);
        if (by != 0.0) sum += double{area[i]} * std::abs(by) / (std::abs(after(3 * i + c)) + faintest * all[c] / whole);
      }
      if (whole > 0.0) worst = std::max(worst, sum / whole);
    }
    return worst;
  }
};

void check(const RadiosityOperator& exchange, View<float> emission, View<float> albedo, View<float> area,
           const SolveOptions& options) {
  const std::size_t n = exchange.points();
  if (emission.size != 3 * n || albedo.size != 3 * n || area.size != n)
    throw std::invalid_argument("emission and albedo are not [points x 3], or area is not [points]");
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0))
    throw std::invalid_argument("tolerance of the radiosity is not in (0, 1)");
  if (!(options.largest_rate > 0.0 && options.largest_rate < 1.0) || options.first_sweeps < 2)
    throw std::invalid_argument("rate of the radiosity's iteration not in (0, 1), or too few sweeps to judge it by");
}

/// B = E + rho H(B); what changed gives the residual of the B before, and its fall the rate.
void sweep(Problem& problem, const std::array<double, 3>& emitted, std::vector<double>& b, Solution& solution) {
  problem.exchange.apply(b, LinearisationPoint::current, problem.irradiance);
  const auto next = [&](std::size_t k) { return problem.next(k); };
  const auto by = [&](std::size_t k) { return problem.next(k) - b[k]; };
  const std::array<double, 3> change = problem.power(by);
  double of_power = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    if (emitted[c] > 0.0) of_power = std::max(of_power, change[c] / emitted[c]);
  // The rate is that of the power: while light goes from room to room the relative residual does not fall.
  if (!solution.history.empty() && solution.history.back() > 0.0) solution.rate = of_power / solution.history.back();
  solution.history.push_back(of_power);
  const double residual = std::max(of_power, problem.relative(by, next));
  solution.settling = solution.residual > 0.0 ? residual / solution.residual : 0.0;
  solution.residual = residual;
  ++solution.sweeps;
  ++solution.applies;
  for (std::size_t k = 0; k < b.size(); ++k)
    b[k] = next(k);
}

/// Jacobi sweeps that are left until the tolerance is reached, as the last one settled.
double sweeps_left(const Solution& solution, double tolerance) {
  if (!(solution.settling < 1.0)) return INFINITY;
  if (solution.settling <= 0.0) return 0.0;
  return std::log(tolerance / solution.residual) / std::log(solution.settling);
}

/// Jacobi until converged, until the rate says that it keeps its light, or until `most` sweeps were made.
bool jacobi(Problem& problem, const std::array<double, 3>& emitted, const SolveOptions& options, unsigned most,
            std::vector<double>& b, Solution& solution) {
  for (unsigned k = 0; k < most && solution.applies < options.most_applies; ++k) {
    sweep(problem, emitted, b, solution);
    if (!std::isfinite(solution.residual)) break;
    if (solution.residual <= options.tolerance) {
      solution.end = SolveEnd::converged;
      return true;
    }
  }
  return false;
}

/// Krylov and a sweep in turn. False when that did not end it.
bool accelerate(Problem& problem, const std::array<double, 3>& emitted, const SolveOptions& options,
                std::vector<double>& b, Solution& solution) {
  constexpr int most_turns = 6;        // another linearisation point changes little: two are the rule
  constexpr double least_inner = 1e-7; // below it are roundings of the device's floats
  double inner = 0.3 * options.tolerance;
  for (int turn = 0; turn < most_turns && solution.applies < options.most_applies; ++turn) {
    const double before = solution.residual;
    std::vector<double>().swap(problem.irradiance); // Krylov has one of its own
    const KrylovResult result =
        solve_krylov(problem.exchange, problem.emission, problem.albedo, inner, most_krylov_steps, b);
    solution.krylov_steps += result.steps;
    solution.applies += result.applies;
    if (!result.useful) return false;
    sweep(problem, emitted, b, solution);
    if (solution.residual <= options.tolerance) {
      solution.end = SolveEnd::converged;
      return true;
    }
    if (!(solution.residual < 0.7 * before)) return false;
    // What is left is measured otherwise than by Krylov's root mean square: in dark places by far.
    inner = std::max(least_inner, inner * std::min(0.3, options.tolerance / solution.residual));
  }
  return false;
}

} // namespace

Solution solve_radiosity(RadiosityOperator& exchange, View<float> emission, View<float> albedo, View<float> area,
                         const SolveOptions& options) {
  check(exchange, emission, albedo, area, options);
  Problem problem{exchange, emission, albedo, area};
  Solution solution;
  std::vector<double> b(emission.begin(), emission.end());
  const std::array<double, 3> emitted = problem.power([&](std::size_t k) { return b[k]; });
  const auto finish = [&]() -> Solution&& {
    solution.radiosity = std::move(b);
    return std::move(solution);
  };
  if (!(emitted[0] + emitted[1] + emitted[2] > 0.0)) {
    solution.end = SolveEnd::converged; // dark
    return finish();
  }
  if (jacobi(problem, emitted, options, options.first_sweeps, b, solution)) return finish();
  // Light that is kept leaves the residual where it began; far below that a rate of 1 is rounding.
  const auto keeps = [&] { return !(solution.rate < options.largest_rate) && !(solution.history.back() < 0.01); };
  if (!keeps() && options.krylov && sweeps_left(solution, options.tolerance) > options.patient_sweeps) {
    const std::vector<double> kept = b;
    if (accelerate(problem, emitted, options, b, solution)) return finish();
    if (!(solution.history.back() < solution.history[options.first_sweeps - 1])) {
      b = kept; // worse than before: from there on as if it had not been
      solution.rate = 0.0;
    }
  }
  // In rounds: the rate is judged by sweeps that follow each other, and may rise as the fast parts of the light die
  // out.
  while (!keeps() && solution.applies < options.most_applies && std::isfinite(solution.residual)) {
    if (jacobi(problem, emitted, options, options.first_sweeps, b, solution)) return finish();
    if (sweeps_left(solution, options.tolerance) > options.most_applies) break;
  }
  solution.end = keeps() ? SolveEnd::keeps_its_light : SolveEnd::stalled;
  return finish();
}

std::string complaint_of(const Solution& solution) {
  if (solution.end == SolveEnd::converged) return "";
  const std::string figures = " after " + std::to_string(solution.applies) +
                              " applies of the exchange the residual is " + std::to_string(solution.residual);
  if (solution.end == SolveEnd::keeps_its_light)
    return "the scene keeps " + std::to_string(100.0 * solution.rate) +
           " % of its light at each bounce, so its radiosity does not settle:" + figures +
           "; lower the albedo, or open the scene";
  return "the radiosity did not converge:" + figures + "; a larger tolerance may be reached";
}

} // namespace pointgi
