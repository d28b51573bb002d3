/// Highlights of lamps on Phong surfaces, where lobe and light are sampled together by the balance heuristic.
#include "host/image/difference.h"
#include "tests/support/scene_parts.h"
#include "tests/support/statistics.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A floor with a lamp above it, seen where the lamp is mirrored. Nothing else is there, so that direct light is all.
/// The lamp's discs are small: rays meet them where they stick out of the lamp, sampled light does not come from there.
std::string floor_and_lamp(double exponent, double lamp_radius, double radiance) {
  return head("0.0, 0.9, 1.6", "0.22, 0.0, 0.9", 14.0, 128, "[32, 24]") + lamp("lamp", radiance) +
         material("gloss", "phong",
                  "albedo = [0.3, 0.3, 0.3]\nspecular = [0.6, 0.6, 0.6]\nexponent = " + number(exponent)) +
         quad("-1.0, 0.0, -1.0", "0.0, 0.0, 3.0", "2.0, 0.0, 0.0", "gloss", 0.04) +
         "[[shape]]\ntype = \"disc\"\ncentre = [0.5, 1.2, 0.0]\nnormal = [0.0, -1.0, 0.0]\nradius = " +
         number(lamp_radius) + "\nspacing = " + number(lamp_radius / 15.0) + "\nmaterial = \"lamp\"\n";
}

Picture render_with(const std::string& scene, const std::string& integrator, int spp, unsigned seed) {
  return render_text(scene, [&](RenderOptions& options) {
    options.integrator = integrator;
    options.spp = spp;
    options.seed = seed;
  });
}

} // namespace

TEST_CASE("the highlight of a small lamp on a glossy floor has little noise", "[long]") {
  const std::string integrator = GENERATE("pointgi", "path");
  const std::string scene = floor_and_lamp(2000.0, 0.015, 6000.0);
  const Picture converged = render_with(scene, integrator, 2048, 77);
  // The highlight is there, and more than the diffuse light around it.
  REQUIRE(largest(converged, "Specular.G") > 3.0 * mean(converged, "Direct.G"));
  const double error = difference(render_with(scene, integrator, 128, 1), "128 spp", converged, "2048 spp").all.rel_mse;
  std::printf("relMSE of the highlight at 128 spp, %s: %.4f\n", integrator.c_str(), error);
  CHECK(error <= 0.05); // 2 where the lobe alone is sampled
}

TEST_CASE("highlights are the same by both integrators, whatever lobe and lamp", "[long]") {
  const double exponent = GENERATE(5.0, 50.0, 2000.0), radius = GENERATE(0.015, 0.5);
  CAPTURE(exponent, radius);
  const std::string scene = floor_and_lamp(exponent, radius, radius < 0.1 ? 6000.0 : 10.0);
  const Picture ours = render_with(scene, "pointgi", 64, 1), path = render_with(scene, "path", 64, 2);
  for (const char* channel : {"R", "Specular.G"})
    CHECK(mean(ours, channel) > 0.0);
  const LightTest test = test_of_light(ours, path);
  CAPTURE(test.part, test.off);
  CHECK(test.p > significance);
}

TEST_CASE("a lobe that sees a uniform sky reflects what it may, by both integrators", "[long]") {
  struct Case {
    double exponent, degrees;
  };
  // Aside the lobe's mean direction is the mirrored one, of which the surface takes the cosine; below the horizon there
  // is nothing of so narrow a lobe.
  const auto [exponent, degrees] = GENERATE(Case{5.0, 0.0}, Case{50.0, 0.0}, Case{2000.0, 0.0}, Case{2000.0, 60.0});
  const std::string integrator = GENERATE("pointgi", "path");
  CAPTURE(exponent, degrees, integrator);
  const double angle = degrees * 3.14159265358979323846 / 180.0;
  const std::string scene =
      head(number(3.0 * std::sin(angle)) + ", 0.0, " + number(3.0 * std::cos(angle)), "0.0, 0.0, 0.0", 0.5, 64) +
      environment(1.0) +
      material("gloss", "phong",
               "albedo = [0.3, 0.3, 0.3]\nspecular = [0.6, 0.6, 0.6]\nexponent = " + number(exponent)) +
      quad("-1.0, -1.0, 0.0", "2.0, 0.0, 0.0", "0.0, 2.0, 0.0", "gloss", 0.1);
  const Picture picture = render_with(scene, integrator, 64, 3);
  double variance = 0.0;
  for (const float v : picture.channels.at("Variance.G"))
    variance += double{v};
  const auto pixels = static_cast<double>(picture.channels.at("G").size());
  // Three deviations of the mean, and what a view of half a degree sees at other angles: 1e-4.
  const double truth = 0.3 + 0.6 * std::cos(angle), deviation = std::sqrt(variance) / pixels;
  CAPTURE(truth, deviation);
  CHECK(deviation < 0.003 * truth);
  CHECK(mean(picture, "G") == Approx(truth).margin(3.0 * deviation + 1e-4));
}
