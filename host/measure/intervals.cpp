#include "host/measure/intervals.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

double student_quantile(double freedom) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double n = std::max(freedom, 2.0);
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

void set_time_intervals(Trade& trade) {
  double squares = 0.0, freedom = 0.0;
  for (const MeasuredRun& run : trade.runs) {
    if (run.repeats.size() < 2) continue;
    double mean = 0.0;
    for (const double seconds : run.repeats)
      mean += std::log(seconds) / static_cast<double>(run.repeats.size());
    for (const double seconds : run.repeats)
      squares += std::pow(std::log(seconds) - mean, 2.0);
    freedom += static_cast<double>(run.repeats.size()) - 1.0;
  }
  if (freedom == 0.0) return;
  const double deviation = std::sqrt(squares / freedom);
  for (MeasuredRun& run : trade.runs) {
    const std::size_t count = run.repeats.size();
    if (count == 0) continue;
    // Of a normal distribution the median of two is their mean; that of three has 0.449 of the variance of one (David
    // and Nagaraja, Order Statistics); that of many pi / 2 of their mean's.
    const double share = (count < 3 ? 1.0 : count == 3 ? 1.347 : 1.571) / static_cast<double>(count);
    const double factor = std::exp(student_quantile(freedom) * deviation * std::sqrt(share));
    const auto [least, most] = std::minmax_element(run.repeats.begin(), run.repeats.end());
    run.seconds.low = std::min(run.seconds.value / factor, *least);
    run.seconds.high = std::max(run.seconds.value * factor, *most);
  }
}

} // namespace pointgi
