#pragma once
/// How long a launch took, where drivers' clocks are not all to be believed.
#include <cstdint>

namespace pointgi {

/// What is known of a launch's time.
struct LaunchTimes {
  std::uint64_t start_ns = 0, end_ns = 0; ///< the device's clock; both 0 where it has none
  double call_seconds = 0.0; ///< of the host's clock, from before the launch was asked for until its end was seen
  double wait_seconds = 0.0; ///< the part of it in which nothing was done but waiting
};

/// Whether the device's clock can be right: it goes forwards, the launch is no longer than the host saw it take, and no
/// hundredth of a long wait.
bool is_believable(const LaunchTimes& times);

/// By the device's clock where it can be right, else by the host's; above 0.
double seconds_of(const LaunchTimes& times);

} // namespace pointgi
