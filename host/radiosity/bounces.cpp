#include "host/radiosity/bounces.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

/// Passes by which a scene that keeps its light is known, and the share that it keeps: as SolveOptions has them.
constexpr unsigned first_passes = 8;

/// Where the tolerance is never reached: noise of passes that differ may not fall below it.
constexpr unsigned most_passes = 10000;

/// Of the worst colour: power of `values` over that of what entered.
double power_share(const ExchangeProblem& problem, const std::vector<double>& values) {
  std::array<double, 3> entered{}, power{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    entered[i % 3] += double{problem.area[i / 3]} * std::fabs(double{problem.emission[i]});
    power[i % 3] += double{problem.area[i / 3]} * std::fabs(values[i]);
  }
  double worst = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    if (entered[c] > 0.0) worst = std::max(worst, power[c] / entered[c]);
  return worst;
}

} // namespace

RadiosityField solve_by_bounces(const ExchangePass& pass, const ExchangedPoints& exchanged, const EnteringLight& light,
                                const BounceOptions& options) {
  if (exchanged.size() == 0) return dark_field(light);
  const ExchangeProblem problem = exchange_problem(exchanged, light);
  const SolveOptions usual;
  RadiosityField field;
  Solution& solution = field.solution;
  std::vector<double> total(problem.emission.begin(), problem.emission.end()), sent = total, gathered,
                                                                               irradiance(total.size(), 0.0);
  double before = power_share(problem, sent);
  if (before == 0.0) { // dark
    solution.end = SolveEnd::converged;
    solution.radiosity = total;
    field.irradiance.resize(light.direct.size);
    return field;
  }
  solution.end = SolveEnd::stalled;
  for (unsigned number = 0; number < (options.only_passes > 0 ? options.only_passes : most_passes); ++number) {
    const bool settled = pass(options.whole ? total : sent, number, gathered);
    ++solution.applies;
    std::vector<double> change(total.size());
    for (std::size_t i = 0; i < total.size(); ++i) {
      const double reflected = double{problem.albedo[i]} * gathered[i];
      change[i] = options.whole ? double{problem.emission[i]} + reflected - total[i] : reflected;
      irradiance[i] = gathered[i] + (options.whole ? 0.0 : irradiance[i]);
      total[i] += change[i];
    }
    sent = change;
    if (options.after_pass)
      options.after_pass(number + 1, irradiance_of_pool(irradiance, exchanged, light.direct.size));
    solution.residual = power_share(problem, change);
    solution.rate = solution.residual / before;
    before = solution.residual;
    solution.history.push_back(solution.residual);
    // What all later passes will add is a geometric series.
    if (settled && solution.residual * std::min(1.0, solution.rate) <=
                       options.tolerance * std::max(1e-12, 1.0 - std::min(1.0, solution.rate))) {
      solution.end = SolveEnd::converged;
      break;
    }
    if (number + 1 >= first_passes && !(solution.rate < usual.largest_rate) && solution.residual > 0.01) {
      solution.end = SolveEnd::keeps_its_light;
      break;
    }
  }
  // So many bounces were asked for, and are there.
  if (solution.end == SolveEnd::stalled && options.only_passes > 0) solution.end = SolveEnd::converged;
  solution.sweeps = solution.applies;
  solution.radiosity = std::move(total);
  field.irradiance = irradiance_of_pool(irradiance, exchanged, light.direct.size);
  return field;
}

} // namespace pointgi
