/// How many samples a picture gets next.
#include "host/app/grow_picture.h"
#include <catch2/catch.hpp>
#include <limits>

using namespace pointgi;

namespace {

constexpr double for_ever = 1e300, unknown = std::numeric_limits<double>::infinity();

std::vector<int> steps(const PictureGoal& goal, double left, double seconds_a_sample, double noise_of_one) {
  std::vector<int> all;
  PictureGoal known = goal;
  int now = 0;
  for (int i = 0; i < 100; ++i) {
    const int next = next_samples(known, now, left, now > 1 ? noise_of_one / now : unknown);
    if (next <= now) return all;
    left -= (next - now) * seconds_a_sample;
    if (known.until) known.seconds_a_sample = seconds_a_sample;
    all.push_back(now = next);
  }
  FAIL("never ends");
  return all;
}

} // namespace

TEST_CASE("a picture of a given number of samples has just these, by passes that double them") {
  PictureGoal goal;
  for (const auto& [samples, expected] : std::vector<std::pair<int, std::vector<int>>>{
           {1, {1}}, {7, {7}}, {32, {32}}, {33, {32, 33}}, {100, {32, 64, 100}}, {512, {32, 64, 128, 256, 512}}}) {
    goal.samples = samples;
    CHECK(steps(goal, for_ever, 0.0, 1.0) == expected);
  }
}

TEST_CASE("a time is used up by whole passes and the rest, and not passed") {
  PictureGoal goal;
  goal.until = 10.0;
  for (const double seconds_a_sample : {0.01, 0.05, 0.3, 0.9, 5.0, 100.0}) {
    INFO(seconds_a_sample);
    goal.seconds_a_sample = seconds_a_sample;
    const std::vector<int> all = steps(goal, 10.0, seconds_a_sample, 1.0);
    REQUIRE_FALSE(all.empty());
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      CHECK(all[i] % 32 == 0); // what grows on is a whole number of passes
    const double used = all.back() * seconds_a_sample;
    CHECK((used <= 10.0 || all.back() == 1));
    CHECK(used + seconds_a_sample >= 10.0 - 1e-9);
  }
  SECTION("one sample shows the pace where nobody knows it") {
    goal.seconds_a_sample = 0.0;
    const std::vector<int> all = steps(goal, 10.0, 0.05, 1.0);
    CHECK(all.front() == 1);
    CHECK(all.back() > 180);
  }
  SECTION("what is less than a pass is made anew only for twice the samples") {
    goal.seconds_a_sample = 0.1;
    CHECK(next_samples(goal, 20, 3.0, unknown) == 20);
    CHECK(next_samples(goal, 20, 5.0, unknown) == 32); // whole passes, which go on
  }
}

TEST_CASE("an error ends the samples as soon as the noise allows it") {
  PictureGoal goal;
  goal.error = 0.01;
  goal.light_error = 0.004;
  goal.noise = {0.5, 1.2};
  const double noise_of_one = 2.0;
  const auto error_at = [&](int samples) { return goal.light_error + goal.noise.noise(noise_of_one, samples); };
  for (const double forecast : {2.0, 0.2, 40.0, 0.0}) { // right, too small, too large, none
    INFO(forecast);
    goal.noise_a_sample = forecast;
    const std::vector<int> all = steps(goal, for_ever, 0.0, noise_of_one);
    REQUIRE_FALSE(all.empty());
    CHECK(error_at(all.back()) <= *goal.error);
    if (forecast <= 2.0) CHECK(error_at(all.back() - 32) > *goal.error); // no more than a pass too many
  }
}

TEST_CASE("an error that the light alone exceeds ends where noise is small beside it, or at the time") {
  PictureGoal goal;
  goal.error = 0.01;
  goal.light_error = 0.02;
  const int samples = steps(goal, for_ever, 0.0, 1.0).back();
  CHECK(samples >= 400); // noise of a quarter of the error
  CHECK(samples < 500);
  goal.until = 10.0;
  goal.seconds_a_sample = 0.1;
  CHECK(steps(goal, 10.0, 0.1, 1.0).back() <= 100);
}
