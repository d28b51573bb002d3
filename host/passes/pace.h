#pragma once
/// How much work goes into a launch.
#include <algorithm>

namespace pointgi {

/// A launch aims at this many seconds: short for a watchdog or a Ctrl-C, long against the cost of launching.
constexpr double launch_seconds = 0.1;

/// Learns from launches how much work, in any unit, the device does in a second.
struct Pace {
  double per_second; ///< a guess before the first launch

  double of_a_launch() const { return per_second * launch_seconds; }
  void learn(double work, double seconds) {
    if (seconds > 0.01 * launch_seconds) // less is mostly the launch itself
      per_second = std::clamp(work / seconds, 0.25 * per_second, 4.0 * per_second);
  }
};

} // namespace pointgi
