/// Eye rays pass through backs, and nothing else does.
#include "tests/support/render.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A room of albedo 1/2 whose inside shines with radiance 1: closed, every surface sends out 1 / (1 - 1/2) = 2. The
/// camera is outside, and all around shines with 8, of which nothing gets in.
std::string closed_room(const std::string& backfaces) {
  return "version = 1\n[render]\nsize = [24, 16]\nspp = 32\n"
         "[camera]\nposition = [5.0, 4.0, 9.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 12.0\n" +
         backfaces +
         "[environment]\nradiance = [8.0, 8.0, 8.0]\n"
         "[[material]]\nname = \"glowing\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
         "emission = [1.0, 1.0, 1.0]\n"
         "[[shape]]\ntype = \"box\"\nmin = [-1.5, -1.5, -1.5]\nmax = [1.5, 1.5, 1.5]\nspacing = 0.1\ninward = true\n"
         "material = \"glowing\"\n";
}

const std::string see_through = "backfaces = \"see_through\"\n";

} // namespace

TEST_CASE("a closed room seen through its near walls keeps its light, by both integrators", "[long]") {
  for (const char* integrator : {"pointgi", "path"}) {
    CAPTURE(integrator);
    const Picture picture =
        render_text(closed_room(see_through), [&](RenderOptions& options) { options.integrator = integrator; });
    CHECK(smallest(picture, "A") == 1.0);
    // Where light of outside came in by way of the near walls, 16 would be seen. Corners, which the exchange takes by
    // clusters, and the paths' noise over 32 samples are within 5 %.
    CHECK(mean(picture, "R") == Approx(2.0).epsilon(0.05));
    // Discs at the edges of the box reach past it, where the light of outside meets them: single pixels, at most 10 of
    // 384 measured. Through the walls all would be bright.
    const auto& red = picture.channels.at("R");
    const auto bright = std::count_if(red.begin(), red.end(), [](float value) { return value > 3.0f; });
    CHECK(static_cast<double>(bright) <= 0.04 * static_cast<double>(red.size()));
  }
  CHECK(largest(render_text(closed_room("backfaces = \"shade\"\n")), "R") == 0.0);
  CHECK(largest(render_text(closed_room("")), "R") == 0.0);
}

TEST_CASE("the picture behind backs is the same in every form, grouping and pass", "[long]") {
  const auto render_by = [](const char* form, const char* grouping) {
    return render_text(closed_room(see_through), [&](RenderOptions& options) {
      options.overrides = {std::string("traversal.form=") + form, std::string("traversal.grouping=") + grouping};
    });
  };
  const Picture steps = render_by("step", "ray");
  for (const char* grouping : {"ray", "packet"}) {
    const Picture wide = render_by("wide", grouping);
    const auto& a = steps.channels.at("Z");
    const auto& b = wide.channels.at("Z");
    double largest_difference = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
      largest_difference = std::max(largest_difference, double{std::fabs(a[i] - b[i])});
    CHECK(largest_difference < 1e-3); // of 10: discs are blended in the order of each tree
  }
}
