#include "host/radiosity/solve_by_operator.h"
#include <stdexcept>

namespace pointgi {

namespace {

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

void check_sizes(View<std::uint32_t> place, const EnteringLight& light) {
  for (const std::uint32_t p : place)
    if (3 * (static_cast<std::size_t>(p) + 1) > light.direct.size)
      throw std::invalid_argument("radiosity: three direct irradiances a point of the pool");
  if (light.emitted.size != 0 && light.emitted.size != light.direct.size)
    throw std::invalid_argument("radiosity: emission of all points of the pool, or of none");
}

/// Of a pool in which nothing exchanges light.
RadiosityField dark_field(const EnteringLight& light) {
  RadiosityField field;
  field.irradiance.resize(light.direct.size);
  field.solution.end = SolveEnd::converged;
  return field;
}

} // namespace

RadiosityField solve_by_operator(RadiosityOperator* device, const ExchangedPoints& exchanged,
                                 const EnteringLight& light, double tolerance, const WorkReport& report) {
  check_sizes(exchanged.place, light);
  if (exchanged.place.size == 0) return dark_field(light);
  const std::size_t points = exchanged.points.size;
  std::vector<double> emission(3 * points), albedo(3 * points), area(points);
  for (std::size_t k = 0; k < points; ++k) {
    const Splat& splat = exchanged.points[k];
    area[k] = splat.area;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = 3 * exchanged.place[k] + c;
      albedo[3 * k + c] = splat.colour[c];
      emission[3 * k + c] = splat.colour[c] * light.direct[at] + (light.emitted.size != 0 ? light.emitted[at] : 0.0f);
    }
  }
  ReportedExchange exchange(*device, report);
  SolveOptions solve;
  solve.tolerance = tolerance;
  RadiosityField field;
  field.solution = solve_radiosity(exchange, emission, albedo, area, solve);
  std::vector<double> gathered;
  exchange.apply(field.solution.radiosity, LinearisationPoint::current, gathered);
  field.irradiance.resize(light.direct.size);
  for (std::size_t k = 0; k < points; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      field.irradiance[3 * exchanged.place[k] + c] = static_cast<float>(gathered[3 * k + c]);
  return field;
}

} // namespace pointgi
