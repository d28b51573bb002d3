#include "host/radiosity/solve_by_operator.h"
#include "octree/parallel.h"
#include <stdexcept>

namespace pointgi {

namespace {

constexpr std::size_t grain = 1 << 14;

/// Passes applies on and reports how many were made.
class ReportedExchange : public RadiosityOperator {
public:
  ReportedExchange(RadiosityOperator& exchange, const WorkReport& report) : exchange_(exchange), report_(report) {}

  std::size_t points() const override { return exchange_.points(); }
  void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) override {
    exchange_.apply(radiosity, about, irradiance);
    report_(std::to_string(++applies_) + " applies of the operator");
  }

private:
  RadiosityOperator& exchange_;
  const WorkReport& report_;
  unsigned applies_ = 0;
};

} // namespace

RadiosityField dark_field(const EnteringLight& light) {
  RadiosityField field;
  field.irradiance.resize(light.direct.size);
  field.solution.end = SolveEnd::converged;
  return field;
}

ExchangeProblem exchange_problem(const ExchangedPoints& exchanged, const EnteringLight& light) {
  for (const std::uint32_t p : exchanged.place)
    if (3 * (static_cast<std::size_t>(p) + 1) > light.direct.size)
      throw std::invalid_argument("radiosity: three direct irradiances a point of the pool");
  if (light.emitted.size != 0 && light.emitted.size != light.direct.size)
    throw std::invalid_argument("radiosity: emission of all points of the pool, or of none");
  const std::size_t points = exchanged.size();
  ExchangeProblem problem{std::vector<float>(3 * points), std::vector<float>(3 * points), std::vector<float>(points)};
  parallel_ranges(points, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Splat& splat = exchanged[k];
      problem.area[k] = splat.area;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = 3 * static_cast<std::size_t>(exchanged.place[k]) + c;
        problem.albedo[3 * k + c] = splat.colour[c];
        problem.emission[3 * k + c] =
            splat.colour[c] * light.direct[at] + (light.emitted.size != 0 ? light.emitted[at] : 0.0f);
      }
    }
  });
  return problem;
}

std::vector<float> irradiance_of_pool(View<double> irradiance, const ExchangedPoints& exchanged, std::size_t size) {
  std::vector<float> of_pool(size);
  parallel_ranges(exchanged.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        of_pool[3 * static_cast<std::size_t>(exchanged.place[k]) + c] = static_cast<float>(irradiance[3 * k + c]);
  });
  return of_pool;
}

RadiosityField solve_by_operator(RadiosityOperator* device, const ExchangedPoints& exchanged,
                                 const EnteringLight& light, double tolerance, const WorkReport& report) {
  if (exchanged.size() == 0) return dark_field(light);
  ReportedExchange exchange(*device, report);
  SolveOptions solve;
  solve.tolerance = tolerance;
  RadiosityField field;
  {
    const ExchangeProblem problem = exchange_problem(exchanged, light);
    field.solution = solve_radiosity(exchange, problem.emission, problem.albedo, problem.area, solve);
  }
  std::vector<double> gathered;
  exchange.apply(field.solution.radiosity, LinearisationPoint::current, gathered);
  field.irradiance = irradiance_of_pool(gathered, exchanged, light.direct.size);
  return field;
}

} // namespace pointgi
