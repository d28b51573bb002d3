#include "host/image/srgb.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("the sRGB curve has the values of IEC 61966-2-1", "[srgb]") {
  // Evaluated in 50 digits from the standard's formulas; floats and powf are good to a few 1e-7 relative.
  CHECK(srgb_to_linear(0.0f) == 0.0f);
  CHECK(srgb_to_linear(1.0f) == Approx(1.0).epsilon(1e-6));
  CHECK(srgb_to_linear(0.5f) == Approx(0.21404114048).epsilon(1e-6));
  CHECK(srgb_to_linear(0.02f) == Approx(0.02 / 12.92).epsilon(1e-6));
  CHECK(linear_to_srgb(0.0f) == 0.0f);
  CHECK(linear_to_srgb(1.0f) == Approx(1.0).epsilon(1e-6));
  CHECK(linear_to_srgb(0.18f) == Approx(0.46135612950).epsilon(1e-6));
  CHECK(linear_to_srgb(0.002f) == Approx(0.002 * 12.92).epsilon(1e-6));
}

TEST_CASE("the sRGB curve and its inverse undo each other and rise", "[srgb]") {
  float last = -1.0f;
  for (int i = 0; i <= 4096; ++i) {
    const float linear = static_cast<float>(i) / 4096.0f;
    // 1e-6 absolute: two powf of a few 1e-7 each.
    CHECK(srgb_to_linear(linear_to_srgb(linear)) == Approx(linear).margin(1e-6));
    CHECK(linear_to_srgb(linear) > last);
    last = linear_to_srgb(linear);
  }
}

TEST_CASE("the two pieces of the sRGB curve meet", "[srgb]") {
  // The standard rounds its thresholds: a step of 2e-9 in linear light and of 3e-8 encoded, beside which the curve
  // itself rises by 8e-7 and 1.3e-6 over the differences below.
  CHECK(srgb_to_linear(0.04045f) == Approx(srgb_to_linear(0.04046f)).margin(1e-6));
  CHECK(linear_to_srgb(0.0031308f) == Approx(linear_to_srgb(0.0031309f)).margin(2e-6));
}
