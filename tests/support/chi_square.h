#pragma once
/// Pearson's chi-square test of counts against masses.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace pointgi::test {

/// Q(a, x), the regularised upper incomplete gamma function: its series below a + 1, its continued fraction by Lentz's
/// method above (Press et al., "Numerical Recipes", section 6.2).
inline double upper_gamma(double a, double x) {
  if (!(x > 0.0)) return 1.0;
  constexpr int most_terms = 100'000;
  constexpr double accuracy = 1e-14, tiny = 1e-300;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int k = 1; k < most_terms && term > accuracy * sum; ++k)
      sum += term *= x / (a + k);
    return 1.0 - sum * scale;
  }
  double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, fraction = d;
  for (int k = 1; k < most_terms; ++k) {
    const double numerator = -k * (k - a);
    b += 2.0;
    d = numerator * d + b;
    c = b + numerator / c;
    if (std::fabs(d) < tiny) d = tiny;
    if (std::fabs(c) < tiny) c = tiny;
    d = 1.0 / d;
    fraction *= d * c;
    if (std::fabs(d * c - 1.0) < accuracy) break;
  }
  return scale * fraction;
}

struct ChiSquare {
  double statistic = 0.0, freedom = 0.0;
  double p = 0.0; ///< probability of a larger statistic where the masses are right
};

/// `masses`: of the bins, 1 together. Bins that expect less than 5, whose counts are not nearly
/// normal, are taken together, smallest first.
inline ChiSquare chi_square(const std::vector<double>& counts, const std::vector<double>& masses) {
  constexpr double least_expected = 5.0;
  const double samples = std::accumulate(counts.begin(), counts.end(), 0.0);
  std::vector<std::size_t> order(masses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return masses[i] < masses[j]; });
  ChiSquare result;
  double expected = 0.0, counted = 0.0;
  for (const std::size_t i : order) {
    expected += samples * masses[i];
    counted += counts[i];
    if (expected < least_expected) continue;
    result.statistic += (counted - expected) * (counted - expected) / expected;
    result.freedom += 1.0;
    expected = counted = 0.0;
  }
  result.freedom -= 1.0;
  result.p = upper_gamma(0.5 * result.freedom, 0.5 * result.statistic);
  return result;
}

} // namespace pointgi::test
