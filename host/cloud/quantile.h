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

/// Values between two that very likely enclose the one of a rank, and how many are below.
struct Enclosed {
  double low, high;
  std::size_t below = 0, at_low = 0; ///< equal values, of flat floors and rounded numbers, are counted and not kept
  std::vector<double> values;        ///< above `low`

  void add(double v) {
    below += v < low ? 1u : 0u;
    at_low += v == low ? 1u : 0u;
    if (v > low && v <= high) values.push_back(v);
  }
};

/// The ends of the brackets, from a regular sample: then few values lie in each.
template <std::size_t Ranks, class Value>
std::array<Enclosed, Ranks> quantile_brackets(std::size_t n, const std::array<std::size_t, Ranks>& ranks,
                                              const Value& value) {
  constexpr auto m = static_cast<double>(quantile_samples);
  std::vector<double> sample(quantile_samples);
  std::array<Enclosed, Ranks> brackets;
  for (std::size_t r = 0; r < Ranks; ++r) {
    for (std::size_t s = 0; s < quantile_samples; ++s)
      sample[s] = static_cast<double>(value(s * n / quantile_samples, r));
    const double share = static_cast<double>(ranks[r]) / static_cast<double>(n);
    const double reach = quantile_margin * std::sqrt(m * share * (1.0 - share)) + 8.0;
    const auto at = [&](double place) {
      const auto found = sample.begin() + static_cast<std::ptrdiff_t>(std::clamp(place, 0.0, m - 1.0));
      std::nth_element(sample.begin(), found, sample.end());
      return *found;
    };
    brackets[r].low = at(m * share - reach);
    brackets[r].high = at(m * share + reach);
  }
  return brackets;
}

/// Fills the brackets.
template <std::size_t Ranks, class Value>
void enclose_values(std::size_t n, std::array<Enclosed, Ranks>& brackets, const Value& value) {
  const std::size_t grain = std::max<std::size_t>(quantile_samples, (n + 31) / 32);
  std::vector<std::array<Enclosed, Ranks>> ranges((n + grain - 1) / grain, brackets);
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    std::array<Enclosed, Ranks>& range = ranges[begin / grain];
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t r = 0; r < Ranks; ++r)
        range[r].add(static_cast<double>(value(i, r)));
  });
  for (const auto& range : ranges)
    for (std::size_t r = 0; r < Ranks; ++r) {
      brackets[r].below += range[r].below;
      brackets[r].at_low += range[r].at_low;
      brackets[r].values.insert(brackets[r].values.end(), range[r].values.begin(), range[r].values.end());
    }
}

inline double nth_value(std::vector<double>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

} // namespace detail

/// For each r the value that would stand at place ranks[r] (below n) if value(0, r) … value(n - 1, r) were sorted; none
/// may be NaN. Works on all cores; `value` is called more than once for an index.
template <std::size_t Ranks, class Value>
std::array<double, Ranks> values_at_ranks(std::size_t n, const std::array<std::size_t, Ranks>& ranks,
                                          const Value& value) {
  std::array<double, Ranks> found{};
  std::array<bool, Ranks> done{};
  if (n > 4 * detail::quantile_samples) {
    auto brackets = detail::quantile_brackets(n, ranks, value);
    detail::enclose_values(n, brackets, value);
    for (std::size_t r = 0; r < Ranks; ++r) {
      detail::Enclosed& b = brackets[r];
      if (ranks[r] < b.below || ranks[r] - b.below >= b.at_low + b.values.size()) continue; // the sample led astray
      const std::size_t rank = ranks[r] - b.below;
      found[r] = rank < b.at_low ? b.low : detail::nth_value(b.values, rank - b.at_low);
      done[r] = true;
    }
  }
  std::vector<double> all;
  for (std::size_t r = 0; r < Ranks; ++r) {
    if (done[r]) continue;
    all.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      all[i] = static_cast<double>(value(i, r));
    found[r] = detail::nth_value(all, ranks[r]);
  }
  return found;
}

/// The same of value(0) … value(n - 1).
template <class Value>
double value_at_rank(std::size_t n, std::size_t rank, const Value& value) {
  return values_at_ranks(n, std::array<std::size_t, 1>{rank}, [&](std::size_t i, std::size_t) { return value(i); })[0];
}

/// Of each axis the values at two ranks, `low` and `high`; position(i)[axis] for i below n.
template <class Position>
std::array<std::array<double, 3>, 2> bounds_at_ranks(std::size_t n, std::size_t low, std::size_t high,
                                                     const Position& position) {
  const auto found = values_at_ranks(n, std::array<std::size_t, 6>{low, low, low, high, high, high},
                                     [&](std::size_t i, std::size_t r) { return position(i)[r % 3]; });
  return {{{found[0], found[1], found[2]}, {found[3], found[4], found[5]}}};
}

/// The place of what a share, 0 .. 1, of n > 0 values is below.
inline std::size_t rank_of_share(std::size_t n, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(n - 1));
}

/// The middle value, the upper one of two, of many; n > 0.
template <class Value>
double median(std::size_t n, const Value& value) {
  return value_at_rank(n, n / 2, value);
}

/// The middle value, the upper one of two, of a few. At least one value.
template <class T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace pointgi
