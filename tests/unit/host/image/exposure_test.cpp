#include "host/image/exposure.h"
#include "host/image/srgb.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace pointgi;

namespace {

std::array<float, 3> grey(double value) {
  const auto v = static_cast<float>(value);
  return {v, v, v};
}

/// Half the picture a surface of radiances about `radiance`, half a background.
ExposureMeter half_and_half(double radiance, double albedo, double background) {
  ExposureMeter meter;
  for (int i = 0; i < 1000; ++i) {
    meter.add(grey(radiance * (0.5 + 0.001 * i)), 1.0f, grey(albedo));
    meter.add(grey(background), 0.0f, grey(0.0));
  }
  return meter;
}

} // namespace

TEST_CASE("the middle of what is lit lands at a grey, white things brighter than black ones") {
  for (const double radiance : {1e-6, 1.0, 1e6})
    for (const double albedo : {0.1, 0.5, 0.9}) {
      const ExposureMeter meter = half_and_half(radiance, albedo, 0.5 * radiance);
      // A bin is a twentieth of a stop wide.
      CHECK(std::exp2(meter.stops()) * radiance == Approx(0.1 + 0.4 * albedo).epsilon(0.04));
    }
}

TEST_CASE("a background counts for the mean of the picture alone") {
  const ExposureMeter bright = half_and_half(0.1, 0.2, 1e4);
  CHECK(bright.mean_at(bright.stops()) == Approx(0.65).margin(0.02));
  const ExposureMeter black = half_and_half(1.0, 0.1, 0.0);
  CHECK(black.mean_at(black.stops()) == Approx(0.3).margin(0.02)); // lighter than the grey of black things
}

TEST_CASE("nearly all of the surfaces stays below white") {
  ExposureMeter meter; // an object in the dark of which a tenth is a thousand times as bright
  for (int i = 0; i < 1000; ++i)
    meter.add(grey(i % 10 == 0 ? 1000.0 : 1.0), 1.0f, grey(0.5));
  CHECK(meter.clipped_at(meter.stops()) < 0.02);
}

TEST_CASE("of nothing, and of what is not finite, comes no exposure") {
  ExposureMeter meter;
  CHECK(meter.stops() == 0.0);
  CHECK(meter.mean_at(0.0) == 0.0);
  for (int i = 0; i < 100; ++i) {
    meter.add(grey(0.0), 1.0f, grey(0.5));
    meter.add(grey(std::numeric_limits<double>::infinity()), 1.0f, grey(0.5));
    meter.add(grey(std::nan("")), 1.0f, grey(0.5));
  }
  CHECK(meter.stops() == 0.0);
  CHECK(meter.lit_share() == 0.0);
  meter.add(grey(0.25), 0.0f, grey(0.0)); // a background alone
  CHECK(std::isfinite(meter.stops()));
}

TEST_CASE("the mean and what is burnt are those of the PNG") {
  ExposureMeter meter;
  for (int i = 0; i < 1000; ++i)
    meter.add({0.001f * static_cast<float>(i), 0.5f, 2.0f}, 1.0f, grey(0.5));
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i)
    sum += linear_to_srgb(0.0005f * static_cast<float>(i)) + linear_to_srgb(0.25f) + 1.0;
  CHECK(meter.mean_at(-1.0) == Approx(sum / 3000.0).margin(0.01));
  CHECK(meter.clipped_at(-1.5) == 0.0);
  CHECK(meter.clipped_at(-0.9) == 1.0);
}
