#pragma once
/// What a timing that was repeated comes to.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace pointgi {

/// The middle value; of an even number the mean of the two middle ones; 0 of none.
inline double median_of_repeats(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

} // namespace pointgi
