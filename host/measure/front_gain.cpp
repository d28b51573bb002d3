#include "host/measure/front_gain.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace pointgi {

double behind(const TradePoint& point, const std::vector<TradePoint>& others) {
  double most = -std::numeric_limits<double>::infinity();
  for (const TradePoint& other : others)
    most = std::max(most, std::min(std::log(point.seconds / other.seconds), std::log(point.error / other.error)));
  return most;
}

double area_gained(const TradePoint& point, const std::vector<TradePoint>& others, const TradePoint& worst) {
  std::vector<TradePoint> sorted = others;
  std::sort(sorted.begin(), sorted.end(),
            [](const TradePoint& a, const TradePoint& b) { return a.seconds < b.seconds; });
  // From one time to the next the least error of the faster ones bounds the area from above.
  double area = 0.0, from = point.seconds, least = worst.error;
  const auto add = [&](double to) {
    if (to > from && least > point.error) area += std::log(to / from) * std::log(least / point.error);
    from = std::max(from, to);
  };
  for (const TradePoint& other : sorted) {
    add(std::min(other.seconds, worst.seconds));
    least = std::min(least, other.error);
  }
  add(worst.seconds);
  return area;
}

} // namespace pointgi
