#include "host/tune/profile.h"
#include "host/tune/profile_answers.h"
#include "host/tune/profile_rays.h"
#include "shared/render_types.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("answers: other splats and distances are wrong, ties at exactly one distance are not") {
  const std::vector<RayAnswer> truth{{0.5f, 3}, {0.25f, 7}, {8.0f, NO_SPLAT}, {100.0f, 1}};
  const auto compared = [&](std::size_t at, RayAnswer answer) {
    std::vector<RayAnswer> found = truth;
    found[at] = answer;
    return compare_answers(found, truth);
  };
  CHECK(compare_answers(truth, truth).wrong == 0);
  CHECK(compared(0, {0.5f, 4}).ties == 1);
  CHECK(compared(0, {0.5f, 4}).wrong == 0);
  CHECK(compared(0, {0.5000001f, 4}).wrong == 1); // nearly is no tie
  CHECK(compared(0, {0.500009f, 3}).wrong == 0);
  CHECK(compared(0, {0.50002f, 3}).wrong == 1);
  CHECK(compared(3, {100.0009f, 1}).wrong == 0); // of the larger of t and 1
  CHECK(compared(3, {100.002f, 1}).wrong == 1);
  CHECK(compared(2, {8.0f, 5}).wrong == 1); // a hit where there is none is no tie
  CHECK(compared(1, {0.25f, NO_SPLAT}).wrong == 1);
  CHECK(compared(1, {NAN, 7}).wrong == 1);
  const std::vector<std::uint32_t> blocked{1, 0, 1};
  CHECK(compare_blocked(std::vector<std::uint32_t>{1, 0, 1}, blocked).wrong == 0);
  CHECK(compare_blocked(std::vector<std::uint32_t>{1, 1, 0}, blocked).wrong == 2);
}

TEST_CASE("flights: a few photons may end elsewhere, more may not") {
  PhotonFlight stored{};
  stored.end = PHOTON_STORED;
  std::fill_n(stored.position, 3, 0.5f);
  std::fill_n(stored.power, 3, 4.0f);
  std::fill_n(stored.emitted, 3, 8.0f);
  std::vector<PhotonFlight> truth(1000, stored);
  PhotonFlight missed{}; // those do not count among the ones of which a few may differ
  missed.end = PHOTON_MISSED;
  truth.insert(truth.end(), 1000, missed);
  const auto with = [&](std::size_t count, const PhotonFlight& other, std::size_t first = 0) {
    std::vector<PhotonFlight> found = truth;
    std::fill_n(found.begin() + static_cast<std::ptrdiff_t>(first), count, other);
    return compare_flights(found, truth).wrong;
  };
  PhotonFlight other = stored;
  other.position[1] = 0.502f;
  CHECK(with(0, other) == 0);
  CHECK(with(10, other) == 0);
  CHECK(with(11, other) == 11);
  other.position[1] = 0.5005f;
  other.power[2] = 4.03f;
  CHECK(with(1000, other) == 0);
  other.power[2] = 4.05f;
  CHECK(with(1000, other) == 1000);
  other = stored;
  other.emitted[0] = NAN;
  CHECK(with(1000, other) == 1000);
  other = stored;
  other.end = PHOTON_ABSORBED;
  CHECK(with(500, other) == 500);
  // Missing and setting out must balance; four deviations of 100 are 40, and one in a hundred may be more.
  CHECK(with(500, missed) == 500);
  CHECK(with(500, stored, 1500) == 500);
  CHECK(with(100, missed) == 100);
  std::vector<PhotonFlight> found = truth;
  std::fill_n(found.begin(), 100, missed);
  std::fill_n(found.begin() + 1500, 100, stored);
  CHECK(compare_flights(found, truth).wrong == 0);
  CHECK(compare_flights(found, truth).ties == 200);
  missed.position[0] = 9.0f; // nothing is asked of where those were
  CHECK(with(1000, missed, 1000) == 0);
}

TEST_CASE("films: a few pixels may differ, more may not") {
  const std::size_t pixels = 1000;
  const std::vector<float> truth(pixels * FILM_CHANNELS, 4.0f);
  const auto with = [&](std::size_t count, int channel, bool lit_alike) {
    std::vector<float> film = truth;
    for (std::size_t p = 0; p < count; ++p)
      film[p * FILM_CHANNELS + channel] += 0.5f;
    return compare_films(film, truth, lit_alike).wrong;
  };
  CHECK(with(0, FILM_COVERAGE, true) == 0);
  CHECK(with(10, FILM_COVERAGE, true) == 0);
  CHECK(with(11, FILM_COVERAGE, true) == 11);
  CHECK(with(500, FILM_NORMAL + 2, true) == 500);
  CHECK(with(500, FILM_DIRECT, true) == 500);
  CHECK(with(500, FILM_DIRECT, false) == 0);
}

namespace {

VariantProfile measured(const TraversalVariant& variant, double speedup) {
  VariantProfile v;
  v.variant = variant;
  for (KernelProfile& k : v.kernels) {
    k.seconds = {1.0 / speedup, 1.0, 0.5 / speedup};
    k.speedup = {speedup, 0.1, 2.0 * speedup};
    k.rays = 100;
  }
  return v;
}

} // namespace

TEST_CASE("the ranking leaves out what is wrong, failed or unfinished, and approximate variants never win") {
  TraversalVariant fast = plain_variant(TraversalForm::wide);
  fast.fast_math = true;
  Profile p;
  for (const double speedup : {1.0, 2.0, 9.0, 8.0, 7.0, 3.0})
    p.variants.push_back(measured(plain_variant(TraversalForm::wide), speedup));
  p.variants[2].kernels[2].wrong = 1;
  p.variants[3].failure = "does not compile";
  p.variants[4].kernels[3].seconds.clear();
  p.variants.push_back(measured(fast, 5.0));
  p.variants.back().kernels[0].wrong = 3;
  CHECK(p.variants[2].wrong());
  CHECK(p.ranking() == std::vector<std::size_t>{6, 5, 1, 0});
  CHECK(p.winner() == &p.variants[5]);
  CHECK(p.variants[5].speedup() == 3.0);
  CHECK(Profile{}.winner() == nullptr);
  // What the scene has nothing for is not waited for.
  p.variants[4].kernels[3].skipped = true;
  CHECK(p.ranking().front() == 4);
}

TEST_CASE("the window lies in the picture's middle and holds about as many pixels as asked") {
  for (const int width : {1, 7, 640, 5000})
    for (const int height : {1, 3, 480, 2000})
      for (const std::size_t pixels : {std::size_t{1}, std::size_t{500}, std::size_t{100000}, std::size_t{1} << 40}) {
        CAPTURE(width, height, pixels);
        const PixelWindow w = middle_window(width, height, pixels);
        REQUIRE((w.x0 >= 0 && w.x0 < w.x1 && w.x1 <= width && w.y0 >= 0 && w.y0 < w.y1 && w.y1 <= height));
        const auto area = static_cast<std::size_t>(w.x1 - w.x0) * (w.y1 - w.y0);
        CHECK((area <= std::max<std::size_t>(pixels, 4) || w.x1 - w.x0 == 1));
      }
  const PixelWindow rows = middle_window(640, 480, 6400);
  CHECK((rows.x0 == 0 && rows.x1 == 640 && rows.y0 == 235 && rows.y1 == 245));
}

TEST_CASE("bounced rays leave the front of their splats, the same ones for a seed") {
  const auto splats = sphere_splats(300);
  const auto rays = bounced_rays(splats, 2000, 5);
  const auto again = bounced_rays(splats, 2000, 5), other = bounced_rays(splats, 2000, 6);
  double mean_cosine = 0.0;
  std::size_t same = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double length2 = 0.0, along = 0.0, from_middle = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double out = rays[i].origin[a] - 0.5; // of a sphere, whose normals these are
      length2 += rays[i].direction[a] * rays[i].direction[a];
      along += out * rays[i].direction[a];
      from_middle += out * out;
    }
    CHECK(length2 == Approx(1.0).epsilon(1e-5));
    mean_cosine += along / std::sqrt(from_middle) / static_cast<double>(rays.size());
    REQUIRE(std::equal(rays[i].direction, rays[i].direction + 3, again[i].direction));
    same += std::equal(rays[i].direction, rays[i].direction + 3, other[i].direction);
  }
  CHECK(same < 10);
  // The mean cosine of a cosine distribution is 2/3, its deviation 0.236: three of them over 2000 rays are 0.016.
  CHECK(std::fabs(mean_cosine - 2.0 / 3.0) < 0.016);
}
