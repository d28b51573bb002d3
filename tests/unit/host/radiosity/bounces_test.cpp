/// Light a bounce at a time, where the exchange is known: two plates, each of which sends the other all it has.
#include "host/radiosity/bounces.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

struct Plates {
  std::vector<Splat> pool = std::vector<Splat>(4);
  std::vector<std::uint32_t> places{3, 1};
  std::vector<float> direct = std::vector<float>(12, 0.0f);
  unsigned passes = 0;

  explicit Plates(float albedo) {
    for (Splat& s : pool) {
      s = {};
      s.area = 0.5f;
      for (float& c : s.colour)
        c = albedo;
    }
    for (std::size_t c = 0; c < 3; ++c)
      direct[9 + c] = 1.0f; // the first plate alone
  }

  /// H of each is B of the other, times `kept`.
  RadiosityField solve(const BounceOptions& options, double kept = 1.0) {
    return solve_by_bounces(
        [&](View<double> b, unsigned number, std::vector<double>& h) {
          CHECK(number == passes++);
          h.assign(6, 0.0);
          for (std::size_t c = 0; c < 3; ++c) {
            h[c] = kept * b[3 + c];
            h[3 + c] = kept * b[c];
          }
          return true;
        },
        {pool, places}, {direct, {}}, options);
  }
};

} // namespace

TEST_CASE("bounces add up to the solution, of all passes or of each one anew") {
  for (const bool whole : {false, true}) {
    Plates plates(0.5f);
    BounceOptions options;
    options.tolerance = 1e-9;
    options.whole = whole;
    const RadiosityField field = plates.solve(options);
    // B1 = 0.5 + 0.5 B2, B2 = 0.5 B1: B1 = 2/3, B2 = 1/3.
    CHECK(field.solution.end == SolveEnd::converged);
    CHECK(field.solution.radiosity[0] == Approx(2.0 / 3.0));
    CHECK(field.solution.radiosity[3] == Approx(1.0 / 3.0));
    REQUIRE(field.irradiance.size() == 12);
    CHECK(field.irradiance[9] == Approx(1.0f / 3.0f));
    CHECK(field.irradiance[3] == Approx(2.0f / 3.0f));
    CHECK(field.irradiance[0] == 0.0f);
    CHECK(field.solution.applies == plates.passes);
  }
}

TEST_CASE("bounces: so many as are asked for, each told of with the light so far") {
  Plates plates(0.5f);
  BounceOptions options;
  options.only_passes = 2;
  std::vector<float> told;
  options.after_pass = [&](unsigned pass, const std::vector<float>& irradiance) {
    CHECK(pass == plates.passes);
    told.push_back(irradiance[3]);
    told.push_back(irradiance[9]);
  };
  const RadiosityField field = plates.solve(options);
  CHECK(field.solution.end == SolveEnd::converged);
  CHECK(plates.passes == 2);
  // First the second plate gets 0.5; then it sends 0.25 back.
  CHECK(told == std::vector<float>{0.5f, 0.0f, 0.5f, 0.25f});
}

TEST_CASE("bounces: what keeps its light is told of, what is dark takes no pass") {
  Plates mirrors(1.0f);
  const RadiosityField kept = mirrors.solve({});
  CHECK(kept.solution.end == SolveEnd::keeps_its_light);
  CHECK(mirrors.passes < 20);
  Plates dark(0.5f);
  dark.direct.assign(12, 0.0f);
  CHECK(dark.solve({}).solution.end == SolveEnd::converged);
  CHECK(dark.passes == 0);
}
