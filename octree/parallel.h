#pragma once
/// A loop over all cores whose result does not depend on how many there are: the body writes only to its own range.
#include <cstddef>
#include <vector>

namespace pointgi {

/// The calling thread's loops call `ask` before each range that this thread takes itself. What `ask` throws ends the
/// loop: ranges that no thread has begun are left out, and the loop throws it. Null: they call nothing.
void before_ranges(void (*ask)());

/// For long loops that are not of ranges: calls the `ask` of this thread, if it has one.
void ask_now();

namespace detail {
/// Calls call(body, range) for every range in [0, ranges).
void run_ranges(std::size_t ranges, void (*call)(const void* body, std::size_t range), const void* body);
} // namespace detail

/// Calls body(begin, end) for consecutive ranges of at most `grain` items that cover [0, n). Ranges run in any order
/// and at the same time, so one may not read what another writes. The first exception thrown in any of them is rethrown
/// here. As many threads as OpenMP would take; one inside another such loop.
template <class Body>
void parallel_ranges(std::size_t n, std::size_t grain, const Body& body) {
  const auto call_range = [&](std::size_t range) {
    const std::size_t begin = range * grain;
    body(begin, begin + grain < n ? begin + grain : n);
  };
  detail::run_ranges((n + grain - 1) / grain,
                     [](const void* f, std::size_t range) { (*static_cast<decltype(&call_range)>(f))(range); },
                     &call_range);
}

/// The sum of add(sum, begin, end) over ranges as above, each begun with `zero`: those of the ranges are added (+=) in
/// their order, so that no rounding depends on how many cores there are.
template <class Sum, class Add>
Sum parallel_sum(std::size_t n, std::size_t grain, const Sum& zero, const Add& add) {
  std::vector<Sum> sums((n + grain - 1) / grain, zero);
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    Sum sum = zero;
    add(sum, begin, end);
    sums[begin / grain] = sum;
  });
  Sum total = zero;
  for (const Sum& sum : sums)
    total += sum;
  return total;
}

} // namespace pointgi
