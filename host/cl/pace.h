#pragma once
/// How much work goes into a launch.
#include "host/cl/device.h"
#include <limits>

namespace pointgi {

/// A launch aims at this many seconds: short for a watchdog or a Ctrl-C, long against the cost of launching.
constexpr double launch_seconds = 0.1;

/// Work-items that keep all of the device's compute units busy. Launches of fewer waste the device, however long they
/// take.
std::size_t busy_work_items(const DeviceInfo& device);

/// Learns from launches how much work fits in launch_seconds. Work is counted in any unit; a launch has at least 1.
class Pace {
public:
  /// `work`: a guess for the first launch. `fewest`, `most`: items of a launch (for_each_batch), whatever their work
  /// is.
  explicit Pace(double work, std::size_t fewest = 1, std::size_t most = std::numeric_limits<std::size_t>::max());

  double of_a_launch() const { return work_; }
  std::size_t fewest() const { return fewest_; }
  std::size_t most() const { return most_; }
  /// Where the size of an item changes from loop to loop.
  void set_fewest(std::size_t fewest) { fewest_ = fewest < 1 ? 1 : fewest > most_ ? most_ : fewest; }

  /// What a launch of `work` took. The next one has at most 4 times the work, and at least a quarter. Figures that
  /// are not positive and finite teach nothing.
  void learn(double work, double seconds);

  /// The device refused a launch of `work`: none will have more than half of it.
  void refused(double work);

private:
  double work_;
  double ceiling_ = 1e15; ///< far from what a size can hold
  std::size_t fewest_, most_;
};

} // namespace pointgi
