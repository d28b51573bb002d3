#include "host/cl/device_clock.h"
#include <algorithm>

namespace pointgi {

namespace {

/// The two clocks may differ in rate, by far less than this, and in when they are read.
constexpr double rate_difference = 0.05, reading_seconds = 1e-3;
/// A wait longer than this is the kernel's, not the driver's. Where the device's clock then counts less than a share,
/// it counts in another unit (micro- for nanoseconds), and launches would grow by as much.
constexpr double long_wait_seconds = 0.05, least_share = 0.01;

double device_seconds(const LaunchTimes& times) {
  return 1e-9 * static_cast<double>(times.end_ns - times.start_ns);
}

} // namespace

bool is_believable(const LaunchTimes& times) {
  if (times.end_ns <= times.start_ns) return false;
  const double seconds = device_seconds(times);
  if (seconds > (1.0 + rate_difference) * times.call_seconds + reading_seconds) return false;
  return times.wait_seconds < long_wait_seconds || seconds > least_share * times.wait_seconds;
}

double seconds_of(const LaunchTimes& times) {
  return is_believable(times) ? device_seconds(times) : std::max(times.call_seconds, 1e-9);
}

} // namespace pointgi
