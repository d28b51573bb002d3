#pragma once
/// A loop over all cores whose result does not depend on how many there are: the body writes only to its own range.
#include <cstddef>
#include <exception>

namespace pointgi {

/// Calls body(begin, end) for consecutive ranges of at most `grain` items that cover [0, n). Ranges run in any order
/// and at the same time, so one may not read what another writes. The first exception thrown in any of them is rethrown
/// here.
template <class Body>
void parallel_ranges(std::size_t n, std::size_t grain, const Body& body) {
  const auto ranges = static_cast<std::ptrdiff_t>((n + grain - 1) / grain);
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic)
  for (std::ptrdiff_t range = 0; range < ranges; ++range) {
    const std::size_t begin = static_cast<std::size_t>(range) * grain;
    try {
      body(begin, begin + grain < n ? begin + grain : n);
    } catch (...) {
#pragma omp critical(pointgi_parallel_ranges)
      failure = failure ? failure : std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

} // namespace pointgi
