/// The test by which samplers are judged, against published quantiles and exact sums.
#include "tests/support/chi_square.h"
#include <catch2/catch.hpp>

using namespace pointgi::test;

namespace {

double tail(double chi2, double freedom) {
  return upper_gamma(0.5 * freedom, 0.5 * chi2);
}

} // namespace

TEST_CASE("the tail of chi-square has its published quantiles") {
  // Abramowitz and Stegun, table 26.8: six digits.
  CHECK(tail(3.84146, 1) == Approx(0.05).epsilon(1e-5));
  CHECK(tail(6.63490, 1) == Approx(0.01).epsilon(1e-5));
  CHECK(tail(18.3070, 10) == Approx(0.05).epsilon(1e-4));
  CHECK(tail(3.94030, 10) == Approx(0.95).epsilon(1e-5));
  CHECK(tail(135.807, 100) == Approx(0.01).epsilon(1e-3));
  CHECK(tail(15.1367, 1) == Approx(1e-4).epsilon(1e-4));
}

TEST_CASE("the tail of chi-square is the exact sum where its degrees of freedom are even") {
  for (const int freedom : {2, 8, 40, 200})
    for (const double relative : {0.3, 0.9, 1.0, 1.2, 2.0}) {
      const double x = 0.5 * relative * freedom; // Q(k, x) = exp(-x) sum of x^i / i! below k
      double term = std::exp(-x), sum = 0.0;
      for (int i = 0; i < freedom / 2; term *= x / ++i)
        sum += term;
      CAPTURE(freedom, relative);
      CHECK(tail(2.0 * x, freedom) == Approx(sum).epsilon(1e-10));
    }
}

TEST_CASE("counts that fit pass, counts that do not fail, small bins are taken together") {
  const std::vector<double> even(10, 0.1);
  CHECK(chi_square(std::vector<double>(10, 100.0), even).p == Approx(1.0));
  CHECK(chi_square(std::vector<double>(10, 100.0), even).freedom == 9.0);
  std::vector<double> one_off(10, 100.0);
  one_off[3] += 60.0, one_off[4] -= 60.0;
  CHECK(chi_square(one_off, even).statistic == Approx(2.0 * 36.0));
  CHECK(chi_square(one_off, even).p < 1e-8);
  // 1000 samples: three bins of 0.002 make one of 6.
  const ChiSquare pooled = chi_square({1.0, 3.0, 2.0, 500.0, 494.0}, {0.002, 0.002, 0.002, 0.5, 0.494});
  CHECK(pooled.freedom == 2.0);
  CHECK(pooled.statistic == Approx(0.0).margin(1e-12));
}
