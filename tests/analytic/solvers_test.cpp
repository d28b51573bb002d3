/// The fast solver against the exact one, point by point (method.md section 4).
#include "tests/support/cache_folder.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include "tests/support/lit_room.h"
#include "tests/support/radiosity.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("fmm and V-map as they come are within 1 % of the direct solver: room with a block, a body and a lamp") {
  const CacheFolder empty; // or the V-map of an earlier run is what is tested
  const LitRoom room(session(), 5000);
  RadiositySettings settings;
  const ExchangeScene scene{room.pools, room.variant, room.points, {}};
  const auto silent = [](const std::string&) {};
  const auto solve = [&](const char* method) {
    settings.method = method;
    return prepare_radiosity(session(), scene, settings)->solve({room.direct, {}}, settings.tolerance, silent);
  };
  const RadiosityField fast = solve("fmm"), exact = solve("direct");
  REQUIRE(fast.solution.end == SolveEnd::converged);
  REQUIRE(exact.solution.end == SolveEnd::converged);
  const double of_b = relative_l2(room.radiosity(fast.irradiance), room.radiosity(exact.irradiance));
  const std::vector<double> h_fast(fast.irradiance.begin(), fast.irradiance.end()),
      h_exact(exact.irradiance.begin(), exact.irradiance.end());
  // 0.62 %; 2.7 % with one share for all points of a pair of clusters (point_samples = 0).
  CHECK(of_b < 0.01);
  CHECK(relative_l2(h_fast, h_exact) < 0.015); // 1.06 %: what surfaces send each other, without the direct light
}
