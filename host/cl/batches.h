#pragma once
/// The one loop of launches: work is cut into launches of about launch_seconds.
#include "host/cl/pace.h"
#include "host/cl/resource_error.h"
#include <algorithm>
#include <functional>
#include <vector>

namespace pointgi {

/// How a loop of launches is watched.
struct LaunchControl {
  std::function<bool()> stop;           ///< asked before every launch; may be empty
  std::function<void(double)> progress; ///< share of the items that is done, after every launch; may be empty
};

/// Items of one unit of work each.
struct EqualItems {
  std::size_t size = 0;

  std::size_t fit(std::size_t, double work) const { return static_cast<std::size_t>(work); }
  double work(std::size_t, std::size_t count) const { return static_cast<double>(count); }
};

/// Items of unequal work. `before`: the work of all items before each one, and of all; one more than there are items.
struct WeighedItems {
  const std::vector<double>& before;
  std::size_t size = before.size() - 1;

  std::size_t fit(std::size_t first, double work) const {
    const auto end =
        std::upper_bound(before.begin() + static_cast<std::ptrdiff_t>(first) + 1, before.end(), before[first] + work);
    return static_cast<std::size_t>(end - before.begin()) - 1 - first;
  }
  double work(std::size_t first, std::size_t count) const { return before[first + count] - before[first]; }
};

/// "<text> even with launches of <count>", for what no smaller launch can mend. `error` is of the same kind.
[[noreturn]] void refuse_smallest(const ResourceError& error, std::size_t count);

/// Calls launch(first, count), which returns the device's seconds, for pieces of the items one after another. A piece
/// holds the work that `pace` says, but not fewer items than keep the device busy (Pace::fewest), and at most
/// Pace::most. Where the device refuses one for want of resources (ResourceError), half of it is tried, down to
/// Pace::fewest; `launch` may throw so from any allocation or launch before the one that adds to results.
/// Returns the number of items done: fewer than all where `stop` said so. Throws what `launch` throws, and
/// ResourceError where the smallest piece is refused.
template <class Items, class Launch>
std::size_t for_each_batch(const Items& items, Pace& pace, const LaunchControl& control, const Launch& launch) {
  std::size_t first = 0;
  while (first < items.size) {
    if (control.stop && control.stop()) break;
    const std::size_t wanted = std::clamp(items.fit(first, pace.of_a_launch()), pace.fewest(), pace.most());
    const std::size_t count = std::min(wanted, items.size - first);
    double seconds = 0.0;
    try {
      seconds = launch(first, count);
    } catch (const ResourceError& error) {
      if (count <= pace.fewest()) refuse_smallest(error, count);
      pace.refused(items.work(first, count));
      continue;
    }
    pace.learn(items.work(first, count), seconds);
    first += count;
    if (control.progress) control.progress(static_cast<double>(first) / static_cast<double>(items.size));
  }
  return first;
}

} // namespace pointgi
