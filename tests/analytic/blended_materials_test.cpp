/// Where two materials meet in one plane, neither darkens the other.
#include "tests/support/number.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A plane under an even sky of radiance 1: on the left a diffuse half of albedo 0.5, on the right one of the material
/// `right`. The camera looks straight down at where they meet.
std::string halves(const std::string& right, const std::string& radiosity) {
  const auto half = [](const char* x, const char* material) {
    return std::string("[[shape]]\ntype = \"quad\"\ncorner = [") + x +
           ", 0.0, -1.0]\nedge_u = [0.0, 0.0, 2.0]\nedge_v = [1.0, 0.0, 0.0]\nspacing = 0.1\nmaterial = \"" + material +
           "\"\n";
  };
  return "version = 1\n[render]\nsize = [32, 8]\nspp = 8\n[camera]\nposition = [0.0, 2.0, 0.0]\nlook_at = [0.0, 0.0, "
         "0.001]\nfov_deg = 2.0\n[[material]]\nname = \"left\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, "
         "0.5]\n[[material]]\nname = \"right\"\n" +
         right + half("-1.0", "left") + half("0.0", "right") +
         "[environment]\nradiance = [1.0, 1.0, 1.0]\n[radiosity]\n" + radiosity;
}

} // namespace

TEST_CASE("a mirror does not darken the diffuse surface that it continues", "[long]") {
  const std::string form = GENERATE("wide", "step");
  // Both halves reflect half of the sky, at every sample: what differs from 0.5 is rounding, of the radiosity too,
  // which has nothing to exchange in a plane.
  const std::string radiosity = GENERATE("method = \"none\"\n", "method = \"direct\"\ndirect_light = \"radiosity\"\n");
  const Picture picture =
      render_text(halves("type = \"mirror\"\nreflectance = [0.5, 0.5, 0.5]\n", radiosity),
                  [&](RenderOptions& options) { options.overrides.push_back("traversal.form=\"" + form + "\""); });
  CAPTURE(form, radiosity);
  CHECK(smallest(picture, "R") > 0.499);
  CHECK(largest(picture, "R") < 0.501);
  CHECK(smallest(picture, "A") == 1.0); // normal and depth are still those of one plane
  CHECK(smallest(picture, "N.Y") > 0.999);
}

TEST_CASE("a lamp does not darken the diffuse surface that it continues") {
  const Picture picture = render_text(
      halves("type = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [0.5, 0.5, 0.5]\n", "method = \"none\"\n"));
  // In one plane the lamp gives the other half nothing.
  CHECK(smallest(picture, "R") > 0.499);
  CHECK(largest(picture, "R") < 0.501);
}
