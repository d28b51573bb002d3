/// The extremes of truths.md section 2 by every method and surface, and at the limits of sizes.
#include "host/error.h"
#include "tests/support/extreme_scenes.h"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// With a mirror besides, so that photons and what mirrors show are in the picture, too.
std::string ball_by_mirror(double s, double m) {
  const auto at = [&](double x, double y, double z) { return numbers(s * x + m, s * y + m, s * z + m); };
  return ball_scene(s, m, 30.0, "") +
         "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\n[[shape]]\ntype = \"quad\"\ncorner = " +
         at(-1.0, 0.0, -1.0) + "\nedge_u = " + numbers(2.0 * s, 0.0, 0.0) + "\nedge_v = " + numbers(0.0, s, 0.0) +
         "\nspacing = " + number(0.1 * s) + "\nmaterial = \"mirror\"\n[caustics]\nphotons = 20000\n";
}

Picture with(const std::string& scene, const std::vector<std::string>& overrides) {
  return render_text(scene, [&](RenderOptions& o) { o.overrides = overrides; });
}

using Settings = std::vector<std::string>;
const std::vector<Settings> kinds = {{"radiosity.method=\"fmm\""},    {"radiosity.method=\"directions\""},
                                     {"radiosity.method=\"direct\""}, {"radiosity.method=\"gather\""},
                                     {"radiosity.method=\"cones\""},  {"traversal.surface=\"mls\""}};

} // namespace

TEST_CASE("every method and surface: the same picture at 1e-6 and 1e6 times the size, and far from the origin",
          "[long]") {
  for (const Settings& kind : kinds) {
    CAPTURE(kind[0]);
    const Picture truth = with(ball_by_mirror(1.0, 0.0), kind);
    CHECK(mean(truth, "R") > 0.02);
    for (const double s : {1e-6, 1e6})
      CHECK(mean_difference(with(ball_by_mirror(s, 0.0), kind), truth) < 1e-4);
    CHECK(mean_difference(with(ball_by_mirror(1.0, 3e6), kind), truth) < 1e-4);
  }
}

TEST_CASE("every method: linear in the light's power, from 1e-20 to 1e20", "[long]") {
  for (const Settings& kind : kinds) {
    CAPTURE(kind[0]);
    const Picture truth = with(ball_scene(1.0), kind);
    for (const double factor : {1e-20, 1e20}) {
      const Picture picture = with(ball_scene(1.0, 0.0, 30.0 * factor), kind);
      const std::vector<float>&a = picture.channels.at("R"), &b = truth.channels.at("R");
      double most = 0.0;
      for (std::size_t i = 0; i < b.size(); ++i)
        most = std::max(most, std::fabs(a[i] / factor - b[i]) / (b[i] + 1e-3)); // NaN is none of these, so:
      CHECK(std::all_of(a.begin(), a.end(), [](float v) { return std::isfinite(v); }));
      CHECK(most < 1e-5);
    }
  }
}

TEST_CASE("a cloud in map coordinates, tiny or vast, is the picture of the cloud of size 1 at the origin", "[long]") {
  const Picture truth = render_ply(sphere_ply(3000, {}));
  CHECK(mean(truth, "A") > 0.1);
  // Eastings and northings of UTM: a million times the size, in the double coordinates of the file.
  for (const Place& place : {Place{1.0, 5e5, 5.4e6, 120.0}, Place{1e-6, 0.0, 0.0, 0.0}, Place{1e6, 0.0, 0.0, 0.0}})
    CHECK(mean_difference(render_ply(sphere_ply(3000, {}, place), place), truth) < 1e-4);
}

TEST_CASE("points closer together than the deepest cell: the octree ends at its limit, one more is refused", "[long]") {
  // A pile within a ten-millionth of the size, which no depth tells apart, behind the middle of the sphere.
  std::vector<std::string> pile;
  for (int i = 0; i < 2000; ++i)
    pile.push_back(number(1e-8 * (i % 10)) + " " + number(1e-8 * (i / 10 % 10)) + " " + number(1e-8 * (i / 100)) +
                   " 0 0 1");
  const std::string cloud = sphere_ply(3000, pile);
  const Picture truth = render_ply(cloud);
  for (const char* depth : {"20", "21"})
    CHECK(mean_difference(render_ply(cloud, {}, {std::string("octree.max_depth=") + depth}), truth) < 1e-4);
  CHECK_THROWS_WITH(render_ply(cloud, {}, {"octree.max_depth=22"}), Contains("max_depth") && Contains("22"));
  for (const char* depth : {"10", "11", "21"}) // of four cells a side ten levels fill a key, whatever is asked for
    CHECK(mean_difference(render_ply(cloud, {}, {"octree.branching=4", std::string("octree.max_depth=") + depth}),
                          truth) < 5e-4);
}

TEST_CASE("a wall of 700,000 points, 61 times as long as high, has the light of the closed form all along", "[long]") {
  // Seen from far off and straight ahead; under a directional light, E cos / pi times the albedo everywhere.
  const std::string wall =
      "version = 1\n[render]\nsize = [610, 10]\nspp = 4\n[radiosity]\nmethod = \"none\"\n"
      "[camera]\nposition = [0.0, 0.0, 6100.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 0.009392\n"
      "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.5, 0.5, 0.5]\n"
      "[[shape]]\ntype = \"quad\"\ncorner = [-30.5, -0.5, 0.0]\nedge_u = [61.0, 0.0, 0.0]\nedge_v = [0.0, 1.0, 0.0]\n"
      "spacing = 0.00933\nmaterial = \"grey\"\n"
      "[[light]]\ntype = \"directional\"\ndirection = [0.0, 0.0, -1.0]\nirradiance = [2.0, 2.0, 2.0]\n";
  const Picture picture = render_text(wall);
  const double expected = 0.5 * 2.0 / 3.14159265358979;
  for (std::size_t y = 1; y < 9; ++y) // the outermost rows and columns hold the border
    for (std::size_t x = 1; x < 609; ++x)
      REQUIRE(picture.channels.at("R")[y * 610 + x] == Approx(expected).epsilon(1e-4));
}

TEST_CASE("a light inside a closed box leaves the outside black, by every method") {
  std::string box = "version = 1\n[render]\nsize = [32, 24]\nspp = 8\n"
                    "[camera]\nposition = [2.0, 1.5, 3.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 50.0\n"
                    "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.8, 0.8, 0.8]\ntwo_sided = true\n"
                    "[[shape]]\ntype = \"box\"\nmin = [-0.5, -0.5, -0.5]\nmax = [0.5, 0.5, 0.5]\nspacing = 0.05\n"
                    "material = \"grey\"\n"
                    "[[light]]\ntype = \"point\"\nposition = [0.0, 0.0, 0.0]\npower_w = [100.0, 100.0, 100.0]\n";
  for (const char* method : {"fmm", "directions", "direct", "gather"}) {
    CAPTURE(method);
    const Picture picture = with(box, {std::string("radiosity.method=\"") + method + "\""});
    CHECK(mean(picture, "A") > 0.05);
    CHECK(largest(picture, "R") < 1e-6 * 100.0);
    CHECK(smallest(picture, "R") >= 0.0);
  }
}

TEST_CASE("pictures of one row or one column, as long as a picture may be, are those of the middle of a square one") {
  for (const char* size : {"1x16384", "16384x1", "1x1"}) {
    const Picture picture = render_text(ball_scene(1.0), [&](RenderOptions& o) {
      o.size = size;
      o.overrides = {"radiosity.method=none"};
    });
    CAPTURE(size);
    CHECK(std::to_string(picture.width) + "x" + std::to_string(picture.height) == size);
    CHECK(largest(picture, "R") < 10.0);
    CHECK(smallest(picture, "R") >= 0.0);
  }
}

TEST_CASE("ten runs give the same bits, photons and light between surfaces among them", "[long]") {
  const std::string scene = ball_by_mirror(1.0, 0.0);
  const Picture first = render_text(scene);
  CHECK(mean(first, "Caustic.R") > 0.0);
  for (int run = 1; run < 10; ++run)
    CHECK(render_text(scene).channels == first.channels);
}
