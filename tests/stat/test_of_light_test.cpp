/// The test by which pictures are compared, on noise that is made: it must reject as seldom as it says, and find what
/// is planted.
#include "tests/support/statistics.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr int width = 32, height = 24;

/// A picture of two materials, left and right of the middle, the second `bias` too bright, with `noise` relative to
/// each value; its Variance is that of a sample of 64, as a renderer knows it.
Picture noisy(std::mt19937& g, double bias, double noise) {
  Picture picture;
  picture.width = picture.full_width = width;
  picture.height = picture.full_height = height;
  picture.window = {0, width, 0, height};
  std::normal_distribution<double> normal;
  std::chi_squared_distribution<double> spread(63);
  for (const char* colour : {"R", "G", "B"}) {
    auto& value = picture.channels[colour];
    auto& variance = picture.channels[std::string("Variance.") + colour];
    auto& albedo = picture.channels[std::string("Albedo.") + colour];
    for (int i = 0; i < width * height; ++i) {
      const bool right = i % width >= width / 2;
      const double truth = (right ? 0.5 * (1.0 + bias) : 2.0), sigma = noise * truth;
      value.push_back(static_cast<float>(truth + sigma * normal(g)));
      variance.push_back(static_cast<float>(sigma * sigma * spread(g) / 63.0));
      albedo.push_back(right ? 0.5f : 0.7f);
    }
  }
  return picture;
}

} // namespace

TEST_CASE("the test of light rejects right pictures as seldom as it says") {
  std::mt19937 g(11);
  int rejected = 0;
  constexpr int trials = 400;
  constexpr double level = 0.05;
  for (int k = 0; k < trials; ++k)
    rejected += test_of_light(noisy(g, 0.0, 0.1), noisy(g, 0.0, 0.1)).p < level;
  // 20 expected of independent tests; parts share pixels, so fewer; a variance of 64 samples that is taken for exact
  // makes the tails of 2304 pixels heavier, so more. 60: six deviations.
  CAPTURE(rejected);
  CHECK(rejected <= 60);
  CHECK(rejected >= 4); // or it rejects nothing
}

TEST_CASE("the test of light finds a bias of 1 % in one material, and says where") {
  // 10 % of noise a pixel are 0.7 % in the mean of 384 pixels, of two pictures: lost. 1 % are 0.07 %: plain.
  std::mt19937 g(12);
  int found = 0, lost = 0;
  for (int k = 0; k < 20; ++k) {
    const LightTest test = test_of_light(noisy(g, 0.01, 0.01), noisy(g, 0.0, 0.01));
    found += test.p < significance && test.part.find("albedo 0.500") != std::string::npos &&
             std::fabs(test.off - 0.01) < 0.003;
    lost += test_of_light(noisy(g, 0.01, 0.1), noisy(g, 0.0, 0.1)).p > significance;
  }
  CHECK(found == 20);
  CHECK(lost >= 15);
  // What is allowed is not found, what is more is.
  CHECK(test_of_light(noisy(g, 0.01, 0.01), noisy(g, 0.0, 0.01), 0.02).p == 1.0);
  CHECK(test_of_light(noisy(g, 0.03, 0.01), noisy(g, 0.0, 0.01), 0.02).p < significance);
}

TEST_CASE("the test of light finds one wrong pixel, and values without noise that differ") {
  std::mt19937 g(13);
  Picture a = noisy(g, 0.0, 0.05);
  const Picture b = noisy(g, 0.0, 0.05);
  a.channels["G"][5 * width + 3] *= 1.8f;
  const LightTest pixel = test_of_light(a, b);
  CHECK(pixel.p < significance);
  CHECK(pixel.part == "G of pixel 3,5");
  Picture still = noisy(g, 0.0, 0.0), other = still;
  CHECK(test_of_light(still, other).p == 1.0);
  other.channels["B"][7] *= 1.0001f;
  CHECK(test_of_light(still, other).p == 0.0);
}
