#pragma once
/// Order statistics of many values without sorting or copying them.
#include "octree/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pointgi {

namespace detail {

constexpr std::size_t quantile_samples = 1 << 14;
constexpr double quantile_margin = 5.0; // standard deviations of the sample's rank

/// Two values of a regular sample that very likely enclose the one of the rank: then few values lie between them.
template <class Value>
std::array<double, 2> quantile_bracket(std::size_t n, std::size_t rank, const Value& value) {
  std::vector<double> sample(quantile_samples);
  for (std::size_t s = 0; s < quantile_samples; ++s)
    sample[s] = value(s * n / quantile_samples);
  std::sort(sample.begin(), sample.end());
  constexpr auto m = static_cast<double>(quantile_samples);
  const double share = static_cast<double>(rank) / static_cast<double>(n);
  const double reach = quantile_margin * std::sqrt(m * share * (1.0 - share)) + 8.0;
  const auto at = [&](double place) { return sample[static_cast<std::size_t>(std::clamp(place, 0.0, m - 1.0))]; };
  return {at(m * share - reach), at(m * share + reach)};
}

/// The values inside the bracket, and how many are below it.
template <class Value>
std::size_t enclosed_values(std::size_t n, const std::array<double, 2>& bracket, const Value& value,
                            std::vector<double>& enclosed) {
  const std::size_t grain = std::max<std::size_t>(quantile_samples, (n + 31) / 32);
  struct Range {
    std::size_t below = 0;
    std::vector<double> enclosed;
  };
  std::vector<Range> ranges((n + grain - 1) / grain);
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    Range& range = ranges[begin / grain];
    for (std::size_t i = begin; i < end; ++i) {
      const double v = value(i);
      range.below += v < bracket[0] ? 1u : 0u;
      if (v >= bracket[0] && v <= bracket[1]) range.enclosed.push_back(v);
    }
  });
  std::size_t below = 0;
  for (const Range& range : ranges) {
    below += range.below;
    enclosed.insert(enclosed.end(), range.enclosed.begin(), range.enclosed.end());
  }
  return below;
}

} // namespace detail

/// The value that would stand at place `rank` (below n) if value(0) … value(n - 1) were sorted; none may be NaN. Works
/// on all cores; `value` is called more than once for an index.
template <class Value>
double value_at_rank(std::size_t n, std::size_t rank, const Value& value) {
  std::vector<double> values;
  if (n > 4 * detail::quantile_samples) {
    const std::size_t below = detail::enclosed_values(n, detail::quantile_bracket(n, rank, value), value, values);
    if (rank >= below && rank - below < values.size()) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank - below);
      std::nth_element(values.begin(), at, values.end());
      return *at;
    }
  }
  values.resize(n); // few, or the sample led astray
  for (std::size_t i = 0; i < n; ++i)
    values[i] = value(i);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The middle value, the upper one of two. At least one value.
inline float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace pointgi
