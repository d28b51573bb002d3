#pragma once
/// The plane of seconds and error, both by their logarithms, in which settings are weighed against each other.
#include <vector>

namespace pointgi {

struct TradePoint {
  double seconds = 0.0, error = 0.0; ///< above 0
};

/// The least that both figures of `point` must fall by, as a factor's logarithm, until none of `others` is better in
/// both. 0 or less: none is; then by how much it is ahead of each of them in one figure at least.
double behind(const TradePoint& point, const std::vector<TradePoint>& others);

/// The area that `point` adds to what `others` leave behind them, up to `worst`: what each of the two figures gains
/// times the range of the other over which it gains it (the hypervolume indicator of multi-objective optimisation,
/// Zitzler and Thiele 1998). 0 where one of them is better in both.
double area_gained(const TradePoint& point, const std::vector<TradePoint>& others, const TradePoint& worst);

} // namespace pointgi
