/// The radiosity that bake writes against what is known (truths.md §1).
#include "host/image/srgb.h"
#include "tests/support/bake.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The inside of a sphere of radius 1 and albedo 0.5 that shines, moved far away.
std::string furnace(double x) {
  return "version = 1\n[[material]]\nname = \"wall\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.0]\n"
         "emission = [0.1, 0.2, 0.3]\n[[shape]]\ntype = \"sphere\"\ncentre = [" +
         std::to_string(x) +
         ", 0.0, 0.0]\nradius = 1.0\ninward = true\nspacing = 0.08\nmaterial = \"wall\"\n"
         "[radiosity]\ntolerance = 1e-4\n";
}

} // namespace

TEST_CASE("a baked furnace: B = pi L / (1 - rho) at every point, and its colour") {
  const double place = GENERATE(0.0, 5e5);
  const std::string mode = GENERATE("shadow_rays", "radiosity");
  CAPTURE(place, mode);
  const auto points = bake(furnace(place), {"radiosity.direct_light=" + mode});
  REQUIRE(points.size() > 1500);
  double mean[3] = {0.0, 0.0, 0.0};
  for (const LitPoint& p : points) {
    // Floats in a cube of 2.2: 2^-24 of it and the double's own 1e-10 at 5e5; the file says it to 1e-6.
    REQUIRE((p.position - Eigen::Vector3d(place, 0.0, 0.0)).norm() == Approx(1.0).margin(1e-6));
    for (int c = 0; c < 3; ++c) {
      mean[c] += p.radiosity[c] / static_cast<double>(points.size());
      const float shown = std::min(1.0f, static_cast<float>(p.radiosity[c] / pi));
      CHECK(p.colour[c] == Approx(255.0 * linear_to_srgb(shown)).margin(0.51)); // to the nearest byte
    }
  }
  // Areas of the samples 1 % (truths.md §1), each bounce repeats it; 64 estimates of direct light a point.
  CHECK(mean[0] == Approx(pi * 0.1 / 0.5).epsilon(0.02));
  CHECK(mean[1] == Approx(pi * 0.2 / 0.5).epsilon(0.02));
  CHECK(mean[2] == Approx(pi * 0.3).epsilon(1e-5)); // black in blue: what it shines with, and nothing else
}

TEST_CASE("baked radiosity is linear in the light, beyond what a byte shows") {
  const auto lit = bake(furnace(0.0)), bright = bake(furnace(0.0), {"material.wall.emission=[1e10, 2e10, 3e10]"});
  REQUIRE(lit.size() == bright.size());
  for (std::size_t i = 0; i < lit.size(); ++i)
    for (int c = 0; c < 3; ++c)
      REQUIRE(bright[i].radiosity[c] == Approx(1e11 * lit[i].radiosity[c]).epsilon(1e-5)); // float rounding
}

TEST_CASE("noise of a lit cloud under an area lamp falls with the light samples, which follow the quality", "[long]") {
  // A floor below a ball that shines: what its points send on meets nothing, so the noise is that of the direct light
  // alone; a flat lamp would be summed up.
  const std::string scene =
      "version = 1\n[[material]]\nname = \"floor\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
      "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [5.0, 5.0, 5.0]\n"
      "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, 0.0, -1.0]\nedge_u = [0.0, 0.0, 2.0]\nedge_v = [2.0, 0.0, 0.0]\n"
      "spacing = 0.1\nmaterial = \"floor\"\n"
      "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.7, 0.0]\nradius = 0.4\nspacing = 0.05\nmaterial = \"lamp\"\n";
  // Relative standard deviation of a point: half the mean square of the difference of two seeds.
  const auto deviation = [&](const std::string& quality, std::vector<std::string> set = {}) {
    std::array<std::vector<LitPoint>, 2> of_seed;
    for (unsigned seed = 0; seed < 2; ++seed) {
      std::vector<std::string> with_seed = set;
      with_seed.push_back("render.seed=" + std::to_string(seed + 1));
      of_seed[seed] = bake(scene, with_seed, quality);
    }
    REQUIRE(of_seed[0].size() == of_seed[1].size());
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < of_seed[0].size(); ++i) {
      const double a = of_seed[0][i].radiosity[1], b = of_seed[1][i].radiosity[1];
      REQUIRE(of_seed[0][i].position == of_seed[1][i].position);
      if (of_seed[0][i].position.y() > 0.25) continue; // the lamp
      squares += 2.0 * (a - b) * (a - b) / ((a + b) * (a + b));
      count += 1.0;
    }
    return std::sqrt(squares / count);
  };
  const double draft = deviation("draft"), normal = deviation("normal"), high = deviation("high");
  CAPTURE(draft, normal, high);
  CHECK(draft > 0.005); // or there is nothing to compare
  // As 1 / sqrt(samples) or faster, as they are stratified; of 400 points' deviation a tenth is chance.
  CHECK(normal < 0.5 * 1.15 * draft);
  CHECK(high < 0.5 * 1.15 * normal);
  CHECK(deviation("draft", {"radiosity.light_samples=256"}) == high); // the scene's word, whatever the quality
  // Without an exchange it is the same light.
  CHECK(deviation("normal", {"radiosity.method=none"}) == Approx(normal).epsilon(0.15));
}
