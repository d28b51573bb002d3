#include "host/cloud/quantile.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;

TEST_CASE("a value at a rank is that of the sorted values", "[cloud]") {
  const std::size_t n = GENERATE(std::size_t{1}, std::size_t{1000}, std::size_t{300'000});
  std::mt19937_64 random(11);
  std::vector<double> values(n);
  SECTION("spread evenly") {
    for (double& v : values)
      v = static_cast<double>(random() >> 11);
  }
  SECTION("over many magnitudes, of either sign") {
    for (double& v : values)
      v = std::ldexp(random() % 2 == 0 ? 1.0 : -1.0, static_cast<int>(random() % 600) - 300);
  }
  SECTION("nearly all equal") {
    for (double& v : values)
      v = random() % 1000 == 0 ? 2.0 : 1.0;
  }
  SECTION("in a row that the sample sees as constant") {
    const std::size_t step = std::max<std::size_t>(1, n / detail::quantile_samples);
    for (std::size_t i = 0; i < n; ++i)
      values[i] = i % step == 0 ? 0.0 : static_cast<double>(i);
  }
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (const std::size_t rank : {std::size_t{0}, n / 100, n / 2, n - 1 - n / 100, n - 1})
    CHECK(value_at_rank(n, rank, [&](std::size_t i) { return values[i]; }) == sorted[rank]);
}
