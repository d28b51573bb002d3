#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A ball of glass of index 1.5 about the origin, looked at from above, and what stands in it and about it.
std::string ball_of_glass(const std::string& spp, const std::string& photons, const std::string& shapes) {
  return "version = 1\n[render]\nsize = [24, 24]\nspp = " + spp +
         "\n[camera]\nposition = [0.0, 1.2, 1.6]\nlook_at = [0.0, -0.1, 0.0]\nfov_deg = 40.0\n"
         "[radiosity]\nmethod = \"none\"\n[caustics]\nphotons = " +
         photons +
         "\n[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n"
         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.8, 0.8, 0.8]\n"
         "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [10.0, 10.0, 10.0]\n"
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.5\nmaterial = \"glass\"\nspacing = "
         "0.03\n" +
         shapes;
}

std::string disc(const std::string& centre, const std::string& normal, const std::string& radius,
                 const std::string& material) {
  return "[[shape]]\ntype = \"disc\"\ncentre = [" + centre + "]\nnormal = [" + normal + "]\nradius = " + radius +
         "\nmaterial = \"" + material + "\"\nspacing = " + (material == "lamp" ? "0.004" : "0.02") + "\n";
}

/// What photons add to the picture, and what paths of this class find.
struct Compared {
  double photons, paths;
};

Compared compare(const std::string& shapes, const std::string& path_class) {
  const auto by_photons = [&](const std::string& photons) {
    return mean(render_text(ball_of_glass("64", photons, shapes)), "G");
  };
  const Picture truth = render_text(ball_of_glass("2048", "0", shapes), [&](RenderOptions& options) {
    options.integrator = "path";
    options.paths = path_class;
  });
  return {by_photons("200000") - by_photons("0"), mean(truth, "G")};
}

} // namespace

// The index squared, 2.25, is what the three would be off by: what stands in glass is seen as by a thin gap of air.
// Measured: 1.6, 1.4 and 3.2 % darker than paths: the estimate's loss at the discs' rims, where it reaches for photons
// beyond, and the lamp's splats that stick out of its rim, which paths meet. The paths' noise is below 1 %.

TEST_CASE("photons stored on what stands in glass are as bright as paths find it", "[long]") {
  const Compared c = compare(disc("0.0, 0.0, 0.0", "0.0, 1.0, 0.0", "0.3", "white") +
                                 disc("0.0, 1.6, -0.6", "0.0, -1.6, 0.6", "0.5", "lamp"),
                             "LS+DS+E");
  CAPTURE(c.photons, c.paths);
  CHECK(c.photons > 0.01);
  CHECK(c.photons == Approx(c.paths).epsilon(0.05));
}

TEST_CASE("photons of a lamp that stands in glass are as bright as paths find them", "[long]") {
  const Compared c = compare(disc("0.0, 0.0, 0.0", "0.0, -1.0, 0.0", "0.2", "lamp") +
                                 disc("0.0, -0.8, 0.0", "0.0, 1.0, 0.0", "1.0", "white"),
                             "LS+DS*E");
  CAPTURE(c.photons, c.paths);
  CHECK(c.photons > 0.01);
  CHECK(c.photons == Approx(c.paths).epsilon(0.05));
}

TEST_CASE("photons from a lamp in glass to a surface in the same glass keep their power", "[long]") {
  const std::string mirror = "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n" +
                             disc("0.0, 0.25, 0.0", "0.0, -1.0, 0.0", "0.3", "mirror");
  const Compared c = compare(disc("-0.2, 0.0, 0.0", "0.0, 1.0, 0.0", "0.12", "lamp") +
                                 disc("0.12, -0.1, 0.0", "0.0, 1.0, 0.0", "0.25", "white") + mirror,
                             "LS+DS+E");
  CAPTURE(c.photons, c.paths);
  CHECK(c.photons > 0.001);
  CHECK(c.photons == Approx(c.paths).epsilon(0.05));
}

TEST_CASE("a point light in glass sends out its power, whatever the glass", "[long]") {
  // From the middle of the ball all of it leaves, be it thrown back now and then: E = P / (4 pi d^2) at the floor's
  // middle.
  const Picture picture = render_text(
      "version = 1\n[render]\nsize = [16, 16]\nspp = 4\n[camera]\nposition = [1.5, -1.0, 0.0]\n"
      "look_at = [0.0, -2.0, 0.0]\nfov_deg = 8.0\n[radiosity]\nmethod = \"none\"\n"
      "[caustics]\nphotons = 400000\ngather_k = 200\n"
      "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n"
      "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.8, 0.8, 0.8]\n"
      "[[light]]\ntype = \"point\"\nposition = [0.0, 0.0, 0.0]\npower_w = [100.0, 100.0, 100.0]\n"
      "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.5\nmaterial = \"glass\"\nspacing = 0.03\n" +
      disc("0.0, -2.0, 0.0", "0.0, 1.0, 0.0", "1.0", "white"));
  const double pi = 3.14159265358979, irradiance = 100.0 / (4.0 * pi * 4.0);
  // The picture's quarter of a metre takes some 1500 photons; the cosines at its rim take 2 %.
  CHECK(mean(picture, "Caustic.G") == Approx(0.8 / pi * irradiance).epsilon(0.08));
}

TEST_CASE("the back of glass is no black back to either integrator", "[long]") {
  // The camera stands in the ball: every ray meets glass from within, some of them first the disc, from its front.
  const std::string scene =
      "version = 1\n[render]\nsize = [16, 16]\nspp = 4\n[camera]\nposition = [0.0, 0.3, 0.0]\n"
      "look_at = [0.0, 0.0, -0.3]\nfov_deg = 60.0\n[environment]\nradiance = [1.0, 1.0, 1.0]\n"
      "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n"
      "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.8, 0.8, 0.8]\n"
      "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.5\nmaterial = \"glass\"\nspacing = 0.05\n" +
      disc("0.0, 0.0, 0.0", "0.0, 1.0, 0.0", "0.2", "white");
  for (const char* integrator : {"pointgi", "path"}) {
    const TemporaryFolder folder;
    render_text(scene, [&](RenderOptions& options) {
      options.integrator = integrator;
      options.stats_file = folder.file("stats.json");
    });
    std::ifstream file(folder.file("stats.json"));
    CHECK(nlohmann::json::parse(file)["render"]["back_face_share"] == 0.0);
  }
}
