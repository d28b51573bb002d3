/// Light next to what shines, and in rooms that get little of a bright outside: against what is known of furnaces, and
/// against the path tracer.
#include "tests/support/bake.h"
#include "tests/support/render.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

std::string diffuse(const std::string& name, double albedo, double emission) {
  const auto grey = [](double v) {
    const std::string text = std::to_string(v);
    return "[" + text + ", " + text + ", " + text + "]\n";
  };
  return "[[material]]\nname = \"" + name + "\"\ntype = \"diffuse\"\nalbedo = " + grey(albedo) +
         "emission = " + grey(emission);
}

std::string box(const std::string& low, const std::string& high, bool inward, double spacing) {
  return "[[shape]]\ntype = \"box\"\nmaterial = \"wall\"\nmin = " + low + "\nmax = " + high +
         "\ninward = " + (inward ? "true" : "false") + "\nspacing = " + std::to_string(spacing) + "\n";
}

/// A closed cube of albedo 0.8 that shines with a radiance of 1: 5 everywhere.
std::string shining_cube(double spacing) {
  return "version = 1\n[render]\nsize = [40, 30]\nspp = 16\n[camera]\nposition = [0.6, 0.2, 0.8]\nlook_at = [-1.0, "
         "-0.3, "
         "-0.6]\nfov_deg = 70.0\n" +
         diffuse("wall", 0.8, 1.0) + box("[-1.0, -1.0, -1.0]", "[1.0, 1.0, 1.0]", true, spacing);
}

/// A room with walls 0.1 thick in a bright sky, with an opening of 0.5 in its ceiling.
std::string room_with_opening(double spacing) {
  std::string text =
      "version = 1\n[render]\nsize = [40, 30]\nspp = 32\n[camera]\nposition = [0.0, 0.9, 0.95]\nlook_at = "
      "[0.0, 0.35, -0.4]\nfov_deg = 70.0\n[environment]\nradiance = [1.0, 1.0, 1.0]\n[radiosity]\nlight_samples = "
      "512\n" +
      diffuse("wall", 0.7, 0.0);
  for (const auto& [low, high] : {std::pair{"[-1.1, -0.1, -1.1]", "[1.1, 0.0, 1.1]"},
                                  {"[-1.1, 0.0, -1.1]", "[-1.0, 2.0, 1.1]"},
                                  {"[1.0, 0.0, -1.1]", "[1.1, 2.0, 1.1]"},
                                  {"[-1.0, 0.0, -1.1]", "[1.0, 2.0, -1.0]"},
                                  {"[-1.0, 0.0, 1.0]", "[1.0, 2.0, 1.1]"},
                                  {"[-1.1, 2.0, -1.1]", "[-0.25, 2.1, 1.1]"},
                                  {"[0.25, 2.0, -1.1]", "[1.1, 2.1, 1.1]"},
                                  {"[-0.25, 2.0, -1.1]", "[0.25, 2.1, -0.25]"},
                                  {"[-0.25, 2.0, 0.25]", "[0.25, 2.1, 1.1]"}})
    text += box(low, high, false, spacing);
  return text;
}

} // namespace

TEST_CASE("in a cube whose walls shine every point has the furnace's answer, beside an edge as well") {
  const double spacing = GENERATE(0.2, 0.1);
  const std::vector<LitPoint> points = bake(shining_cube(spacing));
  REQUIRE(points.size() > 500);
  double mean = 0.0;
  for (const LitPoint& p : points) {
    // 64 estimates of direct light, none above pi: noise of 0.5 %, measured 2 % at the worst of 2400 points.
    CHECK(p.radiosity[1] / pi == Approx(5.0).epsilon(0.03));
    mean += p.radiosity[1] / pi / static_cast<double>(points.size());
  }
  CHECK(mean == Approx(5.0).epsilon(6e-3)); // edges: 0.4 % at a spacing of 0.2
}

TEST_CASE("in a cube whose walls shine no pixel sticks out") {
  const Picture picture = render_text(shining_cube(0.1));
  // One emitter in proportion to its area gave single pixels of 146. 16 estimates: noise of 1 %, five of these.
  CHECK(largest(picture, "G") < 5.3);
  CHECK(smallest(picture, "G") > 4.7);
}

TEST_CASE("a dark room in a bright sky gets the light between its walls that the path tracer finds", "[long]") {
  // The room has a hundredth of what lies outside; 0.15 of its light comes by way of the opening's rim.
  const Picture ours = render_text(room_with_opening(0.1));
  const Picture truth = render_text(room_with_opening(0.1), [](RenderOptions& o) {
    o.integrator = "path";
    o.paths = "LDD+E";
    o.spp = 256;
  });
  CHECK(mean(ours, "Diffuse.G") == Approx(mean(truth, "G")).epsilon(0.05)); // of direct estimates of points: 2 %
}
