/// Intervals of times against what chance gives.
#include "host/measure/intervals.h"
#include "host/repeats.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace pointgi;

namespace {

MeasuredRun run_of(const std::vector<double>& repeats) {
  MeasuredRun run;
  run.repeats = repeats;
  run.seconds.value = median_of_repeats(repeats);
  return run;
}

} // namespace

TEST_CASE("Student's quantile agrees with its table") {
  // Abramowitz and Stegun, table 26.10, column .975.
  CHECK(student_quantile(3.0) == Approx(3.182).epsilon(0.02));
  CHECK(student_quantile(5.0) == Approx(2.571).epsilon(0.002));
  CHECK(student_quantile(10.0) == Approx(2.228).epsilon(0.0005));
  CHECK(student_quantile(120.0) == Approx(1.980).epsilon(0.0005));
}

TEST_CASE("intervals of times hold the true time in about 95 of 100 measurements") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto repeats_of = [&](double seconds, int count) {
    std::vector<double> repeats;
    for (int i = 0; i < count; ++i)
      repeats.push_back(seconds * std::exp(0.08 * normal(random)));
    return repeats;
  };
  int held[4] = {}, asked[4] = {};
  for (int measurement = 0; measurement < 400; ++measurement) {
    Trade trade;
    for (int i = 0; i < 12; ++i)
      trade.runs.push_back(run_of(repeats_of(1.0 + i, 1 + i % 3)));
    set_time_intervals(trade);
    for (int i = 0; i < 12; ++i) {
      const Estimate& seconds = trade.runs[static_cast<std::size_t>(i)].seconds;
      const int count = 1 + i % 3;
      ++asked[count];
      held[count] += seconds.low <= 1.0 + i && 1.0 + i <= seconds.high ? 1 : 0;
    }
  }
  // 1600 of each: three deviations of a share of 0.95 are 0.016. The own range of the run makes some wider, and runs of
  // a measurement share their deviation.
  for (int count = 1; count <= 3; ++count) {
    INFO(count);
    const double share = static_cast<double>(held[count]) / asked[count];
    CHECK(share > 0.925);
    CHECK(share < 0.985);
  }
}

TEST_CASE("intervals of times are as wide as the spread of all says") {
  Trade trade;
  const double e = std::exp(0.1);
  for (int i = 0; i < 4; ++i)
    trade.runs.push_back(run_of({1.0 / e, 1.0, e})); // variance 0.01, eight degrees of freedom
  trade.runs.push_back(run_of({5.0}));
  set_time_intervals(trade);
  CHECK(time_deviation(trade) == Approx(0.1));
  const double quantile = 2.306; // of eight, by the table
  CHECK(std::log(trade.runs[0].seconds.high) == Approx(quantile * 0.1 * std::sqrt(0.449)).epsilon(0.002));
  CHECK(std::log(trade.runs[0].seconds.low) == Approx(-quantile * 0.1 * std::sqrt(0.449)).epsilon(0.002));
  CHECK(std::log(trade.runs[4].seconds.high / 5.0) == Approx(quantile * 0.1).epsilon(0.002));
}

TEST_CASE("of few repetitions the interval is their range, and what is no time does not count") {
  Trade trade;
  trade.runs.push_back(run_of({2.0}));
  MeasuredRun refused;
  refused.refused = "too long";
  trade.runs.push_back(refused);
  trade.runs.push_back(run_of({1.0, 1.2}));
  set_time_intervals(trade);
  CHECK(trade.runs[0].seconds.low == Approx(2.0));
  CHECK(trade.runs[0].seconds.high == Approx(2.0));
  CHECK(trade.runs[1].seconds.high == 0.0);
  CHECK(trade.runs[2].seconds.high == Approx(1.2));
  trade.runs.push_back(run_of({1.0, 1.2, std::numeric_limits<double>::infinity(), 0.0}));
  CHECK(time_deviation(trade) == Approx(std::log(1.2) / std::sqrt(2.0)));
  set_time_intervals(trade);
  CHECK(trade.runs[3].seconds.low == Approx(1.0));
  CHECK(trade.runs[3].seconds.high == Approx(1.2));
}
