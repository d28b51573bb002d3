#include "host/cl/pace.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr double most_growth = 4.0;
/// What a shorter launch takes is mostly the launch itself: it shows that more work fits, never that less does.
constexpr double overhead_seconds = 0.01 * launch_seconds;
/// Work-items of a compute unit. A CPU runs groups of some 8 to 64 one after another in a thread; a GPU hides the
/// latency of memory behind the work-items that it holds at a time, 1024 to 2048 a unit.
constexpr std::size_t items_of_cpu_unit = 64, items_of_gpu_unit = 1024;

} // namespace

std::size_t busy_work_items(const DeviceInfo& device) {
  return std::max(1u, device.compute_units) * (device.is_cpu ? items_of_cpu_unit : items_of_gpu_unit);
}

Pace::Pace(double work, std::size_t fewest, std::size_t most)
    : work_(std::max(1.0, work)), fewest_(std::max<std::size_t>(1, std::min(fewest, most))),
      most_(std::max<std::size_t>(1, most)) {}

void Pace::learn(double work, double seconds) {
  if (!(work > 0.0) || !(seconds > 0.0) || !std::isfinite(work) || !std::isfinite(seconds)) return;
  const double fits = work * (launch_seconds / seconds);
  if (fits < work_ && seconds < overhead_seconds) return;
  // Where `fewest` made the launch larger than work_, its own work is what the next one may be 4 times of.
  const double next = std::clamp(fits, work_ / most_growth, most_growth * std::max(work_, work));
  work_ = std::clamp(next, 1.0, ceiling_);
}

void Pace::refused(double work) {
  ceiling_ = std::clamp(0.5 * work, 1.0, ceiling_);
  work_ = std::min(work_, ceiling_);
}

} // namespace pointgi
