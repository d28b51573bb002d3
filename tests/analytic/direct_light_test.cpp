/// Direct light against the formulas of radiometry. Splat discretisation is an error of its own, so the tests go over
/// three spacings.
#include "tests/support/number.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The picture by direct light alone, which these formulas tell.
template <typename... Adjust>
Picture render_direct(const std::string& scene, const Adjust&... adjust) {
  return render_text(scene + "[radiosity]\nmethod = \"none\"\n", adjust...);
}

/// A floor of albedo 0.6 looked at from aside, a small patch around (x, 0, 0); `light` is appended.
std::string floor_scene(double spacing, double x, const std::string& light, int spp = 64) {
  return "version = 1\n[render]\nsize = [16, 16]\nspp = " + std::to_string(spp) + "\n[camera]\nposition = [" +
         number(x) + ", 2.0, 2.0]\nlook_at = [" + number(x) +
         ", 0.0, 0.0]\nfov_deg = 0.5\n"
         "[[material]]\nname = \"floor\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.3, 0.9]\n"
         "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, 0.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\nedge_v = [4.0, 0.0, 0.0]\n"
         "spacing = " +
         number(spacing) + "\nmaterial = \"floor\"\n" + light;
}

/// Irradiance under a parallel disc light (truths.md §1).
double disc_irradiance(double radiance, double radius, double h, double d) {
  const double s = h * h + d * d + radius * radius;
  return pi * radiance / 2.0 *
         (1.0 - (h * h + d * d - radius * radius) / std::sqrt(s * s - 4.0 * radius * radius * d * d));
}

} // namespace

TEST_CASE("straight below a point light: rho/pi * P/(4 pi d^2)") {
  const double spacing = GENERATE(0.08, 0.04, 0.02), height = GENERATE(0.5, 1.5);
  const Picture picture = render_direct(floor_scene(spacing, 0.0,
                                                    "[[light]]\ntype = \"point\"\nposition = [0.0, " + number(height) +
                                                        ", 0.0]\npower_w = [40.0, 20.0, 10.0]\n"));
  const double irradiance = 1.0 / (4.0 * pi * height * height);
  // 1 %: the issue's bound; the patch is 0.025 wide, over which cos/d² falls by less than 0.1 %.
  CHECK(mean(picture, "R") == Approx(0.6 / pi * 40.0 * irradiance).epsilon(0.01));
  CHECK(mean(picture, "G") == Approx(0.3 / pi * 20.0 * irradiance).epsilon(0.01));
  CHECK(mean(picture, "B") == Approx(0.9 / pi * 10.0 * irradiance).epsilon(0.01));
  CHECK(mean(picture, "A") == 1.0);
}

TEST_CASE("a point light aside: I cos / d^2") {
  const Picture picture = render_direct(floor_scene(
      0.03, 0.8, "[[light]]\ntype = \"point\"\nposition = [0.0, 0.6, 0.0]\npower_w = [40.0, 40.0, 40.0]\n"));
  const double d2 = 0.8 * 0.8 + 0.6 * 0.6; // cos = 0.6
  CHECK(mean(picture, "R") == Approx(0.6 / pi * 40.0 / (4.0 * pi) * 0.6 / d2).epsilon(0.01));
}

TEST_CASE("a directional light: E cos") {
  const Picture picture = render_direct(floor_scene(
      0.03, 0.0, "[[light]]\ntype = \"directional\"\ndirection = [3.0, -4.0, 0.0]\nirradiance = [2.0, 2.0, 2.0]\n"));
  CHECK(mean(picture, "R") == Approx(0.6 / pi * 2.0 * 0.8).epsilon(0.001)); // no discretisation in it: rounding only
}

TEST_CASE("an open floor under a uniform environment reflects rho times its radiance") {
  const Picture picture = render_direct(floor_scene(0.05, 0.0, "[environment]\nradiance = [1.5, 1.5, 1.5]\n"));
  CHECK(mean(picture, "R") == Approx(0.6 * 1.5).epsilon(0.001)); // every sample of the hemisphere reads the same
}

TEST_CASE("a disc light, parallel, on axis and aside") {
  const double spacing = GENERATE(0.08, 0.04, 0.02), aside = GENERATE(0.0, 0.5, 1.0);
  const double radius = 0.4, height = 0.7;
  // 16 x 16 pixels of 64 samples: noise far below 1 %.
  const Picture picture = render_direct(floor_scene(
      0.05, aside,
      "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [5.0, 5.0, 5.0]\n"
      "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 0.7, 0.0]\nnormal = [0.0, -1.0, 0.0]\nradius = 0.4\nspacing = " +
          number(spacing) + "\nmaterial = \"lamp\"\n"));
  CHECK(mean(picture, "R") == Approx(0.6 / pi * disc_irradiance(5.0, radius, height, aside)).epsilon(0.01));
}

TEST_CASE("more lights than are all asked for: one drawn by strength has the same mean") {
  std::string lights;
  double irradiance = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.1 * i - 3.0, power = 1.0 + i % 7, d2 = x * x + 1.0;
    lights += "[[light]]\ntype = \"point\"\nposition = [" + number(x) + ", 1.0, 0.0]\npower_w = [" + number(power) +
              ", 0.0, 0.0]\n";
    irradiance += power / (4.0 * pi) / (d2 * std::sqrt(d2));
  }
  // 65536 stratified draws of lights that differ 30-fold in effect: standard error below 0.3 %.
  const Picture picture = render_direct(floor_scene(0.05, 0.0, lights, 256));
  CHECK(mean(picture, "R") == Approx(0.6 / pi * irradiance).epsilon(0.01));
}

TEST_CASE("a blocker throws a shadow, and its own front is lit") {
  const Picture picture = render_direct(floor_scene(
      0.04, 0.0,
      "[[light]]\ntype = \"point\"\nposition = [0.0, 1.5, 0.0]\npower_w = [40.0, 40.0, 40.0]\n"
      "[[shape]]\ntype = \"quad\"\ncorner = [-0.2, 0.7, -0.2]\nedge_u = [0.0, 0.0, 0.4]\nedge_v = [0.4, 0.0, 0.0]\n"
      "spacing = 0.02\nmaterial = \"floor\"\n"));
  CHECK(largest(picture, "R") == 0.0);
}

TEST_CASE("the inside of a closed box without light is black, whatever shines outside", "[long]") {
  const Picture picture = render_direct(
      "version = 1\n[render]\nsize = [48, 48]\nspp = 32\n"
      "[camera]\nposition = [0.05, 0.9, 0.9]\nlook_at = [-0.1, -0.3, -0.2]\nfov_deg = 100.0\n"
      "[environment]\nradiance = [1.0, 1.0, 1.0]\n"
      "[[material]]\nname = \"wall\"\ntype = \"diffuse\"\nalbedo = [0.9, 0.9, 0.9]\n"
      "[[shape]]\ntype = \"box\"\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\ninward = true\nspacing = "
      "0.05\nmaterial = \"wall\"\n"
      "[[light]]\ntype = \"point\"\nposition = [1.5, 1.2, 1.3]\npower_w = [1000.0, 1000.0, 1000.0]\n"
      "[[light]]\ntype = \"directional\"\ndirection = [-1.0, -0.9, -0.8]\nirradiance = [10.0, 10.0, 10.0]\n");
  CHECK(mean(picture, "A") == 1.0);
  CHECK(largest(picture, "R") < 1e-6);
}

TEST_CASE("emission is seen as it is, from its front only") {
  const std::string lamp =
      "version = 1\n[render]\nsize = [8, 8]\n[camera]\nposition = [0.0, 0.0, 3.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg "
      "= 2.0\n"
      "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\nemission = [7.0, 5.0, 3.0]\n"
      "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.5\nspacing = 0.05\nmaterial = \"lamp\"\n";
  const Picture front = render_direct(lamp + "normal = [0.0, 0.0, 1.0]\n"),
                back = render_direct(lamp + "normal = [0.0, 0.0, -1.0]\n");
  CHECK(mean(front, "R") == Approx(7.0).epsilon(1e-5));
  CHECK(mean(front, "B") == Approx(3.0).epsilon(1e-5));
  CHECK(largest(back, "R") == 0.0);
  CHECK(mean(back, "A") == 1.0);
}

TEST_CASE("channels: depth, position, normal, albedo and id of a floor, and the environment where nothing is") {
  const Picture floor = render_direct(floor_scene(0.05, 0.0, "[environment]\nradiance = [1.0, 1.0, 1.0]\n"));
  CHECK(mean(floor, "Z") == Approx(2.0 * std::sqrt(2.0)).epsilon(1e-3));
  CHECK(std::fabs(mean(floor, "P.Y")) < 1e-5);
  CHECK(mean(floor, "N.Y") == Approx(1.0).epsilon(1e-5));
  CHECK(mean(floor, "Albedo.B") == Approx(0.9).epsilon(1e-5));
  CHECK(largest(floor, "PointId") < 6400.0); // 80 x 80 splats
  const Picture sky = render_direct(floor_scene(0.05, 100.0, "[environment]\nradiance = [0.25, 0.5, 4.0]\n"));
  CHECK(mean(sky, "G") == 0.5);
  CHECK(mean(sky, "A") == 0.0);
  CHECK(sky.uints.at("PointId").front() == 0xffffffffu);
}

TEST_CASE("a sheet stored as two coincident sides is lit on either, and shines from either", "[long]") {
  const std::string sheet = "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, 0.0, -2.0]\nedge_u = [4.0, 0.0, 0.0]\n"
                            "edge_v = [0.0, 0.0, 4.0]\nspacing = 0.05\nmaterial = \"floor\"\n";
  const std::string light = "[[light]]\ntype = \"point\"\nposition = [0.0, 1.0, 0.0]\npower_w = [40.0, 40.0, 40.0]\n";
  for (const char* form : {"traversal.form=step", "traversal.form=wide"}) {
    const auto use_form = [&](RenderOptions& o) { o.overrides = {form}; };
    const Picture one = render_direct(floor_scene(0.05, 0.0, light), use_form);
    const Picture two = render_direct(floor_scene(0.05, 0.0, light + sheet), use_form);
    CHECK(mean(two, "R") == Approx(mean(one, "R")).epsilon(1e-3)); // the same discs: rounding
    const auto lamp = [](const std::string& side) {
      return "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [5.0, 5.0, 5.0]\n"
             "[[shape]]\ntype = \"quad\"\ncorner = [-0.3, 1.0, -0.3]\nedge_u = [0.6, 0.0, 0.0]\nedge_v = [0.0, 0.0, "
             "0.6]\n"
             "spacing = 0.05\nmaterial = \"lamp\"\n" +
             side;
    };
    const std::string other_side = "[[shape]]\ntype = \"quad\"\ncorner = [-0.3, 1.0, -0.3]\nedge_u = [0.0, 0.0, 0.6]\n"
                                   "edge_v = [0.6, 0.0, 0.0]\nspacing = 0.05\nmaterial = \"lamp\"\n";
    const Picture down = render_direct(floor_scene(0.05, 0.0, lamp("")), use_form);
    const Picture both = render_direct(floor_scene(0.05, 0.0, lamp(other_side)), use_form);
    CHECK(mean(down, "R") > 0.1);
    // Half of the light samples go to the side that faces away: the same mean, more noise (16384 samples).
    CHECK(mean(both, "R") == Approx(mean(down, "R")).epsilon(0.02));
  }
}

TEST_CASE("looking into an open vessel one sees its inside, black, and not through it") {
  const Picture picture =
      render_direct("version = 1\n[render]\nsize = [64, 48]\n[camera]\nposition = [0.0, 2.2, "
                    "1.6]\nlook_at = [0.0, 0.9, 0.0]\nfov_deg = 14.0\n"
                    "[environment]\nradiance = [1.0, 1.0, 1.0]\n[[material]]\nname = \"clay\"\ntype "
                    "= \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
                    "[[shape]]\ntype = \"cylinder\"\nbase = [0.0, 0.0, 0.0]\ntop = [0.0, 1.0, "
                    "0.0]\nradius = 0.5\nspacing = 0.03\nmaterial = \"clay\"\n"
                    "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 0.02, 0.0]\nnormal = [0.0, -1.0, "
                    "0.0]\nradius = 0.5\nspacing = 0.03\nmaterial = \"clay\"\n");
  // The frame's middle half looks at the far wall's inside over the near rim.
  for (int y = 12; y < 36; ++y)
    for (int x = 16; x < 48; ++x) {
      CAPTURE(x, y);
      REQUIRE(picture.channels.at("A")[static_cast<std::size_t>(y) * 64 + x] == 1.0f);
    }
}

TEST_CASE("few samples a pixel are no worse than their number") {
  // Variance of the pixels times samples a pixel, under an area light: for independent samples it does not depend on
  // their number, for stratified ones it falls. A fifth to spare for the noise of a variance of 256 pixels.
  const auto variance = [](int spp) {
    const Picture picture = render_direct(floor_scene(
        0.05, 0.5,
        "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [5.0, 5.0, 5.0]\n"
        "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 0.5, 0.0]\nnormal = [0.0, -1.0, 0.0]\nradius = 0.6\n"
        "spacing = 0.03\nmaterial = \"lamp\"\n",
        spp));
    const double middle = mean(picture, "R");
    double sum = 0.0;
    for (const float value : picture.channels.at("R"))
      sum += (value - middle) * (value - middle);
    return spp * sum / static_cast<double>(picture.channels.at("R").size());
  };
  const double one = variance(1);
  for (const int spp : {2, 4, 8, 16, 32, 64}) {
    CAPTURE(spp);
    CHECK(variance(spp) < 1.2 * one);
  }
}
