#include "host/measure/intervals.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

/// Of those that are times.
std::vector<double> logarithms(const std::vector<double>& seconds) {
  std::vector<double> logs;
  for (const double one : seconds)
    if (std::isfinite(one) && one > 0.0) logs.push_back(std::log(one));
  return logs;
}

} // namespace

double student_quantile(double freedom) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double n = std::max(freedom, 2.0);
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

namespace {

/// Of the logarithms of all runs' times about their means.
struct Spread {
  double squares = 0.0, freedom = 0.0;
};

Spread spread_of_times(const Trade& trade) {
  Spread spread;
  for (const MeasuredRun& run : trade.runs) {
    const std::vector<double> logs = logarithms(run.repeats);
    if (logs.size() < 2) continue;
    double mean = 0.0;
    for (const double log : logs)
      mean += log / static_cast<double>(logs.size());
    for (const double log : logs)
      spread.squares += (log - mean) * (log - mean);
    spread.freedom += static_cast<double>(logs.size()) - 1.0;
  }
  return spread;
}

} // namespace

double time_deviation(const Trade& trade) {
  const Spread spread = spread_of_times(trade);
  return spread.freedom > 0.0 ? std::sqrt(spread.squares / spread.freedom) : 0.0;
}

void set_time_intervals(Trade& trade) {
  constexpr double least_freedom = 3.0;
  const Spread spread = spread_of_times(trade);
  for (MeasuredRun& run : trade.runs) {
    const std::vector<double> logs = logarithms(run.repeats);
    const std::size_t count = logs.size();
    if (count == 0) continue;
    const auto [least, most] = std::minmax_element(logs.begin(), logs.end());
    run.seconds.low = std::exp(*least);
    run.seconds.high = std::exp(*most);
    if (spread.freedom < least_freedom) continue;
    // Of a normal distribution the median of two is their mean; that of three has 0.449 of the variance of one (David
    // and Nagaraja, Order Statistics); that of many pi / 2 of their mean's.
    const double share = (count < 3 ? 1.0 : count == 3 ? 1.347 : 1.571) / static_cast<double>(count);
    const double deviation = std::sqrt(spread.squares / spread.freedom * share);
    const double factor = std::exp(student_quantile(spread.freedom) * deviation);
    run.seconds.low = std::min(run.seconds.value / factor, run.seconds.low);
    run.seconds.high = std::max(run.seconds.value * factor, run.seconds.high);
  }
}

} // namespace pointgi
