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

TEST_CASE("bounds at ranks are those of each axis's sorted values", "[cloud]") {
  const std::size_t n = GENERATE(std::size_t{100}, std::size_t{200'000});
  std::mt19937_64 random(12);
  std::vector<std::array<double, 3>> places(n);
  for (auto& place : places)
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(axis) * 20 - 60);
  const std::size_t low = n / 100, high = n - 1 - n / 200;
  const auto bounds = bounds_at_ranks(n, low, high, [&](std::size_t i) { return places[i]; });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> sorted;
    for (const auto& place : places)
      sorted.push_back(place[axis]);
    std::sort(sorted.begin(), sorted.end());
    CHECK(bounds[0][axis] == sorted[low]);
    CHECK(bounds[1][axis] == sorted[high]);
  }
}

TEST_CASE("a median is the upper one of two middle values", "[cloud]") {
  const std::vector<float> values = {4, 1, 3, 2};
  CHECK(median(values) == 3.0f);
  CHECK(median(values.size(), [&](std::size_t i) { return values[i]; }) == 3.0);
}
