#include "host/error.h"
#include "host/image/difference.h"
#include "host/image/ssim.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using Catch::Contains;

namespace {

/// A picture whose three colours are `value(x, y)` times 1, 2 and 4; x and y count from the corner of the full image.
template <typename Value>
Picture picture(PixelWindow window, Value value) {
  Picture p;
  p.window = window;
  p.width = window.x1 - window.x0;
  p.height = window.y1 - window.y0;
  p.full_width = window.x1;
  p.full_height = window.y1;
  float scale = 1.0f;
  for (const char* name : {"R", "G", "B"}) {
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x)
        p.channels[name].push_back(scale * static_cast<float>(value(x, y)));
    scale *= 2.0f;
  }
  return p;
}

double waves(int x, int y) {
  return 0.5 + 0.25 * std::sin(0.7 * x) + 0.125 * std::cos(0.4 * y);
}

/// The definition, window by window: whole ones, but along a side that is too short for one.
double slow_ssim(const std::vector<float>& a, const std::vector<float>& b, int width, int height) {
  double total = 0.0;
  int windows = 0;
  const int aside = width < 11 ? 0 : 5, above = height < 11 ? 0 : 5;
  for (int y = above; y < height - above; ++y)
    for (int x = aside; x < width - aside; ++x, ++windows) {
      double weight = 0.0, mean_a = 0.0, mean_b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
      for (int pass = 0; pass < 2; ++pass) { // means first, then differences from them
        for (int j = std::max(0, y - 5); j <= std::min(height - 1, y + 5); ++j)
          for (int i = std::max(0, x - 5); i <= std::min(width - 1, x + 5); ++i) {
            const double w = std::exp(-((x - i) * (x - i) + (y - j) * (y - j)) / 4.5);
            const std::size_t at = static_cast<std::size_t>(j * width + i);
            if (pass == 0) {
              weight += w, mean_a += w * double{a[at]}, mean_b += w * double{b[at]};
            } else {
              const double p = double{a[at]} - mean_a, q = double{b[at]} - mean_b;
              aa += w * p * p / weight, bb += w * q * q / weight, ab += w * p * q / weight;
            }
          }
        if (pass == 0) mean_a /= weight, mean_b /= weight;
      }
      total += (2.0 * mean_a * mean_b + 1e-4) * (2.0 * ab + 9e-4) /
               ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (aa + bb + 9e-4));
    }
  return total / windows;
}

} // namespace

TEST_CASE("equal pictures differ by nothing") {
  const Picture p = picture({0, 20, 0, 15}, waves);
  const PictureDifference d = difference(p, "a", p, "b");
  CHECK(d.pixels == 300);
  for (const Difference& one : {d.channel[0], d.channel[1], d.channel[2], d.all}) {
    CHECK(one.mse == 0.0);
    CHECK(one.rel_mse == 0.0);
    CHECK(one.bias == 0.0);
    CHECK(one.p99 == 0.0);
    CHECK(one.ssim == Approx(1.0).epsilon(1e-9)); // rounding of double
  }
}

TEST_CASE("planted differences of known size are found") {
  const PixelWindow window{0, 20, 0, 10};
  const Picture b = picture(window, [](int, int) { return 1.0; });
  SECTION("all values a tenth too large") {
    const PictureDifference d = difference(picture(window, [](int, int) { return 1.125; }), "a", b, "b");
    // Colours are 1, 2 and 4: their mean 7/3, eps a hundredth of its square. Exact in binary but for eps.
    CHECK(d.eps == Approx(0.01 * 49.0 / 9.0).epsilon(1e-12));
    for (int k = 0; k < 3; ++k) {
      const double value = 1 << k, off = 0.125 * value;
      CHECK(d.channel[k].mse == Approx(off * off).epsilon(1e-12));
      CHECK(d.channel[k].rel_mse == Approx(off * off / (value * value + d.eps)).epsilon(1e-12));
      CHECK(d.channel[k].bias == Approx(0.125).epsilon(1e-12));
      CHECK(d.channel[k].p99 == off);
    }
    CHECK(d.all.mse == Approx((1.0 + 4.0 + 16.0) / 64.0 / 3.0).epsilon(1e-12));
    CHECK(d.all.bias == Approx(0.125).epsilon(1e-12));
    CHECK(d.all.p99 == 0.5);
  }
  SECTION("three pixels of 200: more than a hundredth, so the 99th percentile sees them; one does not") {
    const auto spoilt = [&](int count) {
      return difference(picture(window, [=](int x, int y) { return y == 4 && x < count ? 3.0 : 1.0; }), "a", b, "b");
    };
    CHECK(spoilt(3).channel[0].p99 == 2.0);
    CHECK(spoilt(1).channel[0].p99 == 0.0);
    CHECK(spoilt(1).channel[0].mse == Approx(4.0 / 200.0).epsilon(1e-12));
    CHECK(spoilt(1).channel[0].bias == Approx(0.01).epsilon(1e-12));
    CHECK(spoilt(3).all.ssim < 0.999);
    CHECK(spoilt(3).all.ssim < spoilt(1).all.ssim);
  }
  SECTION("differences that cancel are no bias") {
    const PictureDifference d =
        difference(picture(window, [](int x, int) { return x % 2 == 0 ? 0.5 : 1.5; }), "a", b, "b");
    CHECK(d.all.bias == 0.0);
    CHECK(d.channel[0].mse == 0.25);
  }
  SECTION("a black truth") {
    const PictureDifference d = difference(b, "a", picture(window, [](int, int) { return 0.0; }), "b");
    CHECK(d.eps == 0.01);
    CHECK(std::isinf(d.all.bias));
    CHECK(d.channel[0].rel_mse == Approx(100.0));
  }
}

TEST_CASE("only the area that both windows hold is compared") {
  // Equal where they overlap, from (6, 5) to (12, 9); otherwise far apart.
  const auto inside = [](int x, int y) { return x >= 6 && x < 12 && y >= 5 && y < 9; };
  const Picture a = picture({0, 12, 0, 9}, [&](int x, int y) { return inside(x, y) ? waves(x, y) : 100.0; });
  const Picture b = picture({6, 30, 5, 40}, [&](int x, int y) { return inside(x, y) ? waves(x, y) : -100.0; });
  const PictureDifference d = difference(a, "a", b, "b");
  CHECK(d.pixels == 24);
  CHECK(d.area.x0 == 6);
  CHECK(d.area.x1 == 12);
  CHECK(d.area.y0 == 5);
  CHECK(d.area.y1 == 9);
  CHECK(d.all.mse == 0.0);
}

TEST_CASE("pixels that are not finite are left out and counted") {
  const PixelWindow window{0, 8, 0, 8};
  Picture a = picture(window, waves), b = a;
  a.channels["G"][5] = NAN;
  b.channels["B"][6] = INFINITY;
  const PictureDifference d = difference(a, "a", b, "b");
  CHECK(d.not_finite == 2);
  CHECK(d.pixels == 62);
  CHECK(d.all.mse == 0.0);
}

TEST_CASE("structural similarity is that of its definition, and does not depend on the exposure") {
  const auto [width, height] = GENERATE(std::pair(23, 17), std::pair(11, 17), std::pair(10, 30), std::pair(7, 5));
  std::vector<float> a, b;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      a.push_back(static_cast<float>(waves(x, y)));
      b.push_back(static_cast<float>(0.9 * waves(x, y) + 0.05 * ((x * 7 + y * 3) % 5)));
    }
  const double similarity = ssim(a, b, width, height);
  CHECK(similarity == Approx(slow_ssim(a, b, width, height)).epsilon(1e-9)); // both in double
  CHECK(similarity < 0.99);
  CHECK(ssim(b, a, width, height) == Approx(similarity).epsilon(1e-12));
  CHECK(ssim({0.5f}, {0.5f}, 1, 1) == Approx(1.0));
  const PixelWindow window{0, 16, 0, 16};
  const auto pair = [&](double scale) {
    return difference(picture(window, [&](int x, int y) { return scale * (waves(x, y) + 0.1 * (x % 2)); }), "a",
                      picture(window, [&](int x, int y) { return scale * waves(x, y); }), "b");
  };
  CHECK(pair(1024.0).all.ssim == Approx(pair(1.0).all.ssim).epsilon(1e-6)); // a power of two: but for float's rounding
  CHECK(pair(1024.0).all.rel_mse == Approx(pair(1.0).all.rel_mse).epsilon(1e-9));
}

TEST_CASE("pictures that cannot be compared are refused by name") {
  const Picture p = picture({0, 4, 0, 4}, waves);
  Picture grey = p;
  grey.channels.erase("G");
  CHECK_THROWS_WITH(difference(grey, "grey.exr", p, "b.exr"),
                    Contains("grey.exr") && Contains("\"G\"") && Contains("B, R"));
  CHECK_THROWS_WITH(difference(p, "a.exr", grey, "grey.exr"), Contains("grey.exr"));
  CHECK_THROWS_WITH(difference(p, "a.exr", picture({4, 8, 0, 4}, waves), "b.exr"), Contains("no pixel in common"));
}
