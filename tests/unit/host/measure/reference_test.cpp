/// Errors against a noisy reference, and their intervals.
#include "host/measure/reference.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;

namespace {

constexpr int width = 64, height = 48;

enum class Noise { gaussian, skewed };

/// A smooth truth, seen with noise of `sigma` relative to it, Gaussian or as a gamma distribution's.
Picture noisy(double sigma, unsigned seed, double factor = 1.0, Noise noise = Noise::gaussian) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const double variance = std::fmax(sigma * sigma, 1e-12);
  std::gamma_distribution<double> gamma(1.0 / variance, variance);
  const auto relative = [&] { return noise == Noise::skewed ? gamma(engine) : 1.0 + sigma * normal(engine); };
  Picture picture;
  picture.width = picture.full_width = width;
  picture.height = picture.full_height = height;
  picture.window = {0, width, 0, height};
  for (const char* colour : Reference::colours) {
    std::vector<float>& values = picture.channels[colour];
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        values.push_back(static_cast<float>((1.0 + 0.5 * x / width) * factor * relative()));
  }
  return picture;
}

Estimate estimate_of(const std::vector<double>& errors, int columns = width, int rows = height) {
  ErrorOfRepeats one;
  one.add(errors, columns, rows, 0.0);
  return one.estimate();
}

/// The halves' product over the square of their mean.
double error_without_correction(const Picture& picture, const Picture& x, const Picture& y) {
  double sum = 0.0;
  const double eps = difference(x, "x", x, "x").eps;
  for (const char* colour : Reference::colours)
    for (std::size_t i = 0; i < x.channels.at(colour).size(); ++i) {
      const double a = double{picture.channels.at(colour)[i]}, p = double{x.channels.at(colour)[i]},
                   q = double{y.channels.at(colour)[i]}, b = 0.5 * (p + q);
      sum += (a - p) * (a - q) / (b * b + eps);
    }
  return sum / (3.0 * width * height);
}

bool holds(const Estimate& e, double truth) {
  return e.low <= truth && truth <= e.high;
}

} // namespace

TEST_CASE("the halves' noise falls out of errors") {
  const Reference reference(noisy(0.03, 1), noisy(0.03, 2));
  CHECK(reference.own_noise() == Approx(0.5 * 0.0009).epsilon(0.1));
  const Estimate of_truth = estimate_of(reference.errors(noisy(0.0, 3)));
  CHECK(holds(of_truth, 0.0));
  CHECK(of_truth.high < 0.0001); // the halves alone would be wrong by 0.0009
  const double error = 0.04;
  CHECK(reference.error(noisy(0.2, 4)) == Approx(error).epsilon(0.1));
}

TEST_CASE("a single reference's variance is taken off") {
  Picture alone = noisy(0.02, 5);
  const double with_noise = Reference(alone).error(noisy(0.0, 6));
  CHECK(with_noise == Approx(0.0004).epsilon(0.1));
  CHECK(Reference(alone).own_noise() == 0.0);
  const Picture truth = noisy(0.0, 7);
  for (const char* colour : Reference::colours) {
    std::vector<float>& variance = alone.channels[std::string("Variance.") + colour];
    for (const float value : truth.channels.at(colour))
      variance.push_back(0.0004f * value * value);
  }
  const Reference reference(alone);
  CHECK(reference.own_noise() == Approx(0.0004).epsilon(0.05));
  CHECK(holds(estimate_of(reference.errors(noisy(0.0, 6))), 0.0));
}

TEST_CASE("what noise adds by the denominator of relMSE is taken off", "[long]") {
  // Of skewed noise, too, as path tracers have it, and of a picture that is biased as well as noisy.
  constexpr unsigned trials = 40;
  const Picture exact = noisy(0.0, 1);
  for (const Noise noise : {Noise::gaussian, Noise::skewed})
    for (const double bias : {0.0, -0.1})
      for (const double variance : {1e-3, 1e-2, 3e-2, 1e-1}) {
        double off = 0.0, half_width = 0.0, plain = 0.0;
        for (unsigned trial = 0; trial < trials; ++trial) {
          const auto half = [&](unsigned k) { return noisy(std::sqrt(2.0 * variance), 3 * trial + k, 1.0, noise); };
          const Picture picture = noisy(0.1, 3 * trial + 3, 1.0 + bias), x = half(1), y = half(2);
          const Reference reference(x, y);
          const Estimate found = estimate_of(reference.errors(picture));
          const double truth = difference(picture, "a", exact, "b").all.rel_mse;
          off += (found.value - truth) / trials;
          half_width += 0.5 * (found.high - found.low) / trials;
          plain += (error_without_correction(picture, x, y) - truth) / trials;
        }
        INFO((noise == Noise::skewed ? "skewed" : "Gaussian")
             << ", bias " << bias << ", variance " << variance << ": off by " << off << ", without correction by "
             << plain << ", half the interval is " << half_width);
        CHECK(std::fabs(off) < std::fabs(plain));
        // What is left is of higher order. Its own noise over the trials is below a tenth of half_width.
        if (variance < 5e-2) CHECK(std::fabs(off) < (variance < 2e-3 ? 0.1 : 0.5) * half_width);
      }
}

TEST_CASE("what the noise of a single reference adds by the denominator is taken off") {
  constexpr unsigned trials = 40;
  constexpr double variance = 1e-2;
  const Picture exact = noisy(0.0, 1);
  double off = 0.0, half_width = 0.0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    Picture alone = noisy(std::sqrt(variance), 2 * trial + 1);
    for (const char* colour : Reference::colours)
      for (const float value : exact.channels.at(colour))
        alone.channels[std::string("Variance.") + colour].push_back(static_cast<float>(variance) * value * value);
    const Picture picture = noisy(0.1, 2 * trial + 2, 0.9);
    const Estimate found = estimate_of(Reference(alone).errors(picture));
    off += (found.value - difference(picture, "a", exact, "b").all.rel_mse) / trials;
    half_width += 0.5 * (found.high - found.low) / trials;
  }
  INFO("off by " << off << ", half the interval is " << half_width);
  CHECK(std::fabs(off) < 0.5 * half_width);
}

TEST_CASE("intervals of the error hold the truth about 95 times of 100") {
  constexpr unsigned trials = 200;
  constexpr double sigma = 0.2;
  unsigned held = 0;
  double truth = 0.0; // sigma² but for the eps of relMSE
  std::vector<Estimate> found;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const Reference reference(noisy(0.05, 3 * trial + 1), noisy(0.05, 3 * trial + 2));
    found.push_back(estimate_of(reference.errors(noisy(sigma, 3 * trial + 3))));
    truth += found.back().value / trials;
  }
  CHECK(truth == Approx(sigma * sigma).epsilon(0.02));
  for (const Estimate& e : found)
    held += holds(e, truth) ? 1 : 0;
  // Binomial: 190 of 200 are expected, and 183 to 197 are within 2.2 deviations of 3.1. Too wide is no fault here.
  CHECK(held >= 183);
  CHECK(held <= 199);
}

TEST_CASE("intervals of repeated pictures hold the truth, also where the error is in few places") {
  constexpr unsigned trials = 200;
  // Noise in a stripe alone: tiles differ widely without chance.
  const auto striped = [](unsigned seed) {
    Picture picture = noisy(0.0, 1);
    const Picture noise = noisy(0.4, seed);
    for (const char* colour : Reference::colours)
      for (int y = 0; y < height; ++y)
        for (int x = 10; x < 24; ++x) {
          const auto i = static_cast<std::size_t>(y * width + x);
          picture.channels[colour][i] = noise.channels.at(colour)[i];
        }
    return picture;
  };
  double truth = 0.0, width_of_two = 0.0, width_of_one = 0.0;
  std::vector<Estimate> found;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const Reference reference(noisy(0.05, 4 * trial + 1), noisy(0.05, 4 * trial + 2));
    ErrorOfRepeats repeats;
    for (const unsigned seed : {4 * trial + 3, 4 * trial + 4}) {
      const Picture picture = striped(seed);
      repeats.add(reference.errors(picture), width, height, reference.deviation(picture));
      if (repeats.count() == 1) width_of_one += repeats.estimate().high - repeats.estimate().low;
    }
    found.push_back(repeats.estimate());
    width_of_two += found.back().high - found.back().low;
    truth += found.back().value / trials;
  }
  unsigned held = 0;
  for (const Estimate& e : found)
    held += holds(e, truth) ? 1 : 0;
  CHECK(held >= 183);
  CHECK(width_of_two < 0.5 * width_of_one);
}

TEST_CASE("the change of an error from one setting to another is told where the errors' own intervals do not tell it") {
  // Both are off by as much in a stripe; the second has a little more noise everywhere.
  const auto striped = [](double sigma, unsigned seed) {
    Picture picture = noisy(sigma, seed);
    for (const char* colour : Reference::colours)
      for (int y = 0; y < height; ++y)
        for (int x = 10; x < 24; ++x)
          picture.channels[colour][static_cast<std::size_t>(y * width + x)] *= 0.4f;
    return picture;
  };
  for (const unsigned pictures : {1u, 2u}) {
    constexpr unsigned trials = 200;
    std::vector<Estimate> changes;
    unsigned apart = 0;
    double truth = 0.0;
    for (unsigned trial = 0; trial < trials; ++trial) {
      const unsigned seed = 6 * trial;
      const Reference reference(noisy(0.05, seed + 1), noisy(0.05, seed + 2));
      ErrorOfRepeats before, after;
      for (unsigned i = 0; i < pictures; ++i)
        for (auto [error, sigma] : {std::pair(&before, 0.1), std::pair(&after, 0.13)}) {
          const Picture picture = striped(sigma, seed + 3 + i);
          error->add(reference.errors(picture), width, height, reference.deviation(picture));
        }
      changes.push_back(after.change_from(before));
      truth += changes.back().value / trials;
      apart += after.estimate().low > before.estimate().high ? 1 : 0;
    }
    INFO(pictures);
    CHECK(truth == Approx(0.13 * 0.13 - 0.1 * 0.1).epsilon(0.2)); // relative noise is the same in the stripe
    unsigned held = 0, told = 0;
    for (const Estimate& change : changes) {
      held += holds(change, truth) ? 1 : 0;
      told += change.low > 0.0 ? 1 : 0;
    }
    CHECK(held >= 183); // as above
    CHECK(told >= 190);
    if (pictures == 1) CHECK(apart == 0);
  }
}

TEST_CASE("the deviation by the reference's noise is what it varies by") {
  const Picture picture = noisy(0.2, 1);
  double sum = 0.0, squares = 0.0, told = 0.0;
  constexpr unsigned trials = 200;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const Reference reference(noisy(0.1, 2 * trial + 2), noisy(0.1, 2 * trial + 3));
    const double error = reference.error(picture);
    sum += error;
    squares += error * error;
    told += reference.deviation(picture) / trials;
  }
  const double mean = sum / trials, deviation = std::sqrt(squares / trials - mean * mean);
  CHECK(told == Approx(deviation).epsilon(0.2)); // 5 % of its own noise
}

TEST_CASE("intervals widen where errors are few and large") {
  std::vector<double> even(width * height, 1.0), few(width * height, 0.0);
  for (std::size_t i = 0; i < few.size(); i += 512)
    few[i] = 512.0;
  const Estimate flat = estimate_of(even), rare = estimate_of(few);
  CHECK(flat.value == Approx(1.0));
  CHECK(flat.high == Approx(1.0));
  CHECK(rare.value == Approx(1.0));
  CHECK(rare.low < 0.6);
  // Borders that are no whole tiles count by their pixels.
  const Estimate cut = estimate_of(std::vector<double>(13 * 9, 2.0), 13, 9);
  CHECK(cut.value == Approx(2.0));
  CHECK(cut.low == Approx(2.0));
}
