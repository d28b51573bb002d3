/// The path tracer against what is known of light between surfaces (truths.md §1), and its own statistics.
#include "tests/support/number.h"
#include "tests/support/render.h"
#include "tests/support/run_program.h"
#include "tests/support/statistics.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

Picture trace(const std::string& scene, const std::string& paths = "", unsigned seed = 1,
              const std::vector<std::string>& set = {}) {
  return render_text(scene, [&](RenderOptions& options) {
    options.integrator = "path";
    options.paths = paths;
    options.seed = seed;
    options.overrides = set;
  });
}

/// The inside of a sphere of radius 1, seen from within.
std::string closed_sphere(double albedo, double spacing, const std::string& emission, const std::string& light) {
  const std::string rho = number(albedo);
  return "version = 1\n[render]\nsize = [24, 16]\nspp = 64\n[camera]\nposition = [0.3, 0.2, 0.4]\n"
         "look_at = [-0.5, 0.1, -1.0]\nfov_deg = 70.0\n[[material]]\nname = \"wall\"\ntype = \"diffuse\"\nalbedo = [" +
         rho + ", " + rho + ", " + rho + "]\n" + emission +
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = true\nspacing = " +
         number(spacing) + "\nmaterial = \"wall\"\n" + light;
}

/// An open box of coloured walls with a ball in it, under a lamp, a point light and a pale sky: every kind of light.
/// The red wall's albedo is `red` times that of the others.
std::string room(double albedo = 0.7, double red = 1.0) {
  const std::string rho = number(albedo);
  const auto quad = [](const std::string& corner, const std::string& u, const std::string& v, const char* material) {
    return "[[shape]]\ntype = \"quad\"\ncorner = [" + corner + "]\nedge_u = [" + u + "]\nedge_v = [" + v +
           "]\nspacing = 0.08\nmaterial = \"" + material + "\"\n";
  };
  return "version = 1\n[render]\nsize = [32, 24]\nspp = 64\n[camera]\nposition = [0.1, 1.0, 3.4]\n"
         "look_at = [0.0, 0.9, 0.0]\nfov_deg = 40.0\n[environment]\nradiance = [0.2, 0.3, 0.4]\n"
         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [" +
         rho + ", " + rho + ", " + rho + "]\n[[material]]\nname = \"red\"\ntype = \"diffuse\"\nalbedo = [" +
         number(red * albedo) +
         ", 0.0, 0.0]\n[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\n"
         "emission = [9.0, 8.0, 7.0]\n" +
         quad("-1.0, 0.0, -1.0", "0.0, 0.0, 2.0", "2.0, 0.0, 0.0", "white") +
         quad("-1.0, 2.0, -1.0", "2.0, 0.0, 0.0", "0.0, 0.0, 2.0", "white") +
         quad("-1.0, 0.0, -1.0", "2.0, 0.0, 0.0", "0.0, 2.0, 0.0", "white") +
         quad("-1.0, 0.0, -1.0", "0.0, 2.0, 0.0", "0.0, 0.0, 2.0", "red") +
         quad("1.0, 0.0, -1.0", "0.0, 0.0, 2.0", "0.0, 2.0, 0.0", "white") +
         "[[shape]]\ntype = \"sphere\"\ncentre = [0.3, 0.4, 0.0]\nradius = 0.4\nspacing = 0.05\nmaterial = \"white\"\n"
         "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 1.95, 0.0]\nnormal = [0.0, -1.0, 0.0]\nradius = 0.3\n"
         "spacing = 0.05\nmaterial = \"lamp\"\n"
         "[[light]]\ntype = \"point\"\nposition = [-0.5, 1.0, 0.6]\npower_w = [4.0, 4.0, 4.0]\n";
}

const std::vector<std::string> step_form = {"traversal.form=step"};

/// In every pixel, tile and material, by the noise that both tell of themselves.
void check_same(const Picture& a, const Picture& b) {
  const LightTest test = test_of_light(a, b);
  CAPTURE(test.part, test.off);
  CHECK(test.p > significance);
}

} // namespace

TEST_CASE("furnace: a closed sphere that shines everywhere has the radiance E/(1 - rho)", "[long]") {
  const double albedo = GENERATE(0.5, 0.9), spacing = GENERATE(0.08, 0.04, 0.02);
  CAPTURE(albedo, spacing);
  // 1 %: the noise of 24576 paths is 0.1 %, and at albedo 0.9 a wall that lost 0.1 % a bounce would be 1 % too dark.
  const Picture picture = trace(closed_sphere(albedo, spacing, "emission = [1.0, 1.0, 1.0]\n", ""));
  CHECK(mean(picture, "R") == Approx(1.0 / (1.0 - albedo)).epsilon(0.01));
}

TEST_CASE("a point light in the middle of a closed sphere: rho I / (pi R^2 (1 - rho)) on every wall") {
  const double albedo = GENERATE(0.5, 0.9), spacing = GENERATE(0.08, 0.04, 0.02), power = 40.0;
  CAPTURE(albedo, spacing);
  const Picture picture = trace(closed_sphere(
      albedo, spacing, "", "[[light]]\ntype = \"point\"\nposition = [0.0, 0.0, 0.0]\npower_w = [40.0, 40.0, 40.0]\n"));
  const double truth = albedo * power / (4.0 * pi) / (pi * (1.0 - albedo));
  CHECK(mean(picture, "G") == Approx(truth).epsilon(0.01)); // as the furnace
  // No noise in it, only flat discs for a sphere: they lie up to (spacing / R)² / 2 off it.
  CHECK(mean(picture, "Direct.G") == Approx(truth * (1.0 - albedo)).epsilon(0.005));
  CHECK(mean(picture, "R") == Approx(mean(picture, "Direct.R") + mean(picture, "Diffuse.R")).epsilon(1e-5));
}

TEST_CASE("classes of paths: each bounce in a closed sphere brings rho times the one before", "[long]") {
  const std::string scene = closed_sphere(0.6, 0.02, "emission = [1.0, 1.0, 1.0]\n", "");
  // 1 %: noise of 24576 paths a picture, 0.2 %.
  double expected = 1.0;
  for (const char* paths : {"LE", "LDE", "LDDE", "LDDDE"}) {
    CAPTURE(paths);
    CHECK(mean(trace(scene, paths), "R") == Approx(expected).epsilon(0.01));
    expected *= 0.6;
  }
  CHECK(mean(trace(scene, "LDDD+E"), "R") == Approx(std::pow(0.6, 3) / 0.4).epsilon(0.01));
  CHECK(mean(trace(scene, "LE,LDDE"), "R") == Approx(1.36).epsilon(0.01));
  CHECK(mean(trace(scene, "", 1, {"render.max_depth=0"}), "R") == 1.0);
  CHECK(mean(trace(scene, "", 1, {"render.max_depth=2"}), "R") == Approx(1.96).epsilon(0.01));
}

TEST_CASE("direct light alone is the renderer's own picture", "[long]") {
  const std::string scene = room();
  const Picture direct = render_text(scene + "[radiosity]\nmethod = \"none\"\n",
                                     [](RenderOptions&o) {
                                       o.overrides = {"radiosity.direct_light=shadow_rays", "render.adaptive=false"};
                                     }),
                paths = trace(scene, "LE,LDE");
  for (const char* channel : {"R", "G", "B", "Z", "N.X", "Albedo.R", "Variance.B"}) {
    CAPTURE(channel);
    CHECK(paths.channels.at(channel) == direct.channels.at(channel)); // the same samples: bit-identical
  }
  CHECK(largest(paths, "Diffuse.R") == 0.0);
  check_same(direct, trace(scene, "LE,LDE", 2)); // others: within noise
  // The whole picture holds the same direct light, and more.
  const Picture all = trace(scene);
  CHECK(all.channels.at("Direct.G") == direct.channels.at("G"));
  CHECK(mean(all, "R") > 1.1 * mean(direct, "R"));
}

TEST_CASE("walls of albedo 0 leave what shines, exactly", "[long]") {
  const std::string scene = room(0.0);
  const Picture direct = render_text(scene), all = trace(scene);
  for (const char* colour : {"R", "G", "B"})
    CHECK(all.channels.at(colour) == direct.channels.at(colour));
}

TEST_CASE("all paths are those of every class together", "[long]") {
  const std::string scene = room();
  const Picture all = trace(scene);
  check_same(all, trace(scene, "LD+E,LE", 2));
  const double sum =
      mean(trace(scene, "LE,LDE", 3), "G") + mean(trace(scene, "LDDE", 4), "G") + mean(trace(scene, "LDDD+E", 5), "G");
  CHECK(sum == Approx(mean(all, "G")).epsilon(0.02)); // noise of 49152 paths a picture: 0.5 % (the z-test above)
}

TEST_CASE("two seeds agree within their variance, and the variance tells the noise") {
  const std::string scene = room();
  const Picture a = trace(scene, "LDD+E", 1), b = trace(scene, "LDD+E", 2);
  check_same(a, b);
  // Strata make the true noise smaller than that of independent samples, by which it is told; half of it is the random
  // rest of the path. A wrong variance is off by the number of samples, or by 2.
  for (const char* colour : {"R", "G", "B"}) {
    const double square = mean_square_deviation(a, b, colour);
    CHECK(square > 0.4);
    CHECK(square < 1.2);
  }
}

TEST_CASE("a bias of 1 % in one material is found in its own pixels", "[long]") {
  const std::vector<std::string> many = {"render.spp=2048"};
  const Picture truth = trace(room(), "", 1, many);
  const LightTest right = test_of_light(trace(room(), "", 2, many), truth),
                  wrong = test_of_light(trace(room(0.7, 1.01), "", 2, many), truth);
  CAPTURE(right.part, right.p, wrong.part, wrong.p, wrong.off);
  CHECK(right.p > significance);
  CHECK(wrong.p < significance);
  CHECK(wrong.part == "R of albedo 0.700 0.000 0.000");
  CHECK(wrong.off == Approx(0.01).epsilon(0.4));
}

TEST_CASE("strata are not tied to each other: the mean of many samples has no error that stays", "[long]") {
  // If each cell of a pixel's grid always met the same part of the lamps, two seeds would stay apart by more than their
  // variance tells (3 at this number of samples); untied strata are below 1.
  const std::vector<std::string> many = {"render.spp=4096", "render.size=[16, 12]"};
  const std::string scene = room();
  const Picture a = trace(scene, "", 1, many), b = trace(scene, "", 2, many);
  check_same(a, b);
  for (const char* colour : {"R", "G", "B"})
    CHECK(mean_square_deviation(a, b, colour) < 1.2);
}

TEST_CASE("the variance falls with the number of samples, in one pass and over many") {
  const std::string scene = room();
  const double few = mean(trace(scene, "LDD+E", 1, {"render.spp=16"}), "Variance.G"),
               many = mean(trace(scene, "LDD+E", 1, {"render.spp=256"}), "Variance.G");
  CHECK(few / many == Approx(16.0).epsilon(0.15)); // the variance's own noise: rare bright paths
  CHECK(std::isinf(largest(trace(scene, "LDE", 1, {"render.spp=1"}), "Variance.G"))); // unknown
  // A uniform sky on an open floor: every sample reads the same, and a spread as small is not lost in large sums.
  const Picture flat = trace("version = 1\n[render]\nsize = [8, 8]\nspp = 4096\n[camera]\nposition = [0.0, 2.0, 2.0]\n"
                             "look_at = [0.0, 0.0, 0.0]\nfov_deg = 0.5\n[environment]\nradiance = [1000.0, 1.0, 1.0]\n"
                             "[[material]]\nname = \"floor\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n[[shape]]\n"
                             "type = \"quad\"\ncorner = [-2.0, 0.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\n"
                             "edge_v = [4.0, 0.0, 0.0]\nspacing = 0.1\nmaterial = \"floor\"\n");
  CHECK(mean(flat, "R") == Approx(600.0).epsilon(1e-4));
  CHECK(largest(flat, "Variance.R") <
        1e-8 * 600.0 * 600.0); // rounding: (1e-6)² / 4096; sums of squares leave 1e-7 / 64
}

TEST_CASE("both forms of the octree and other seeds trace the same light", "[long]") {
  const std::string scene = room();
  const Picture wide = trace(scene, "", 1, {"traversal.form=wide"}), step = trace(scene, "", 1, step_form);
  check_same(wide, step);
  CHECK(mean(wide, "R") == Approx(mean(step, "R")).epsilon(1e-3)); // the same paths but for a few that rounding parts
  CHECK(mean(trace(scene, "", 1, {"traversal.form=step", "octree.branching=4"}), "R") ==
        Approx(mean(step, "R")).epsilon(1e-3));
}

TEST_CASE("the same seed gives the same bits on one thread and on two") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("room.toml", room());
  std::vector<Picture> pictures;
  for (const char* threads : {"1", "2"}) {
    const std::string out = folder.file(std::string("out") + threads + ".exr");
    REQUIRE(run_program("render " + scene + " --integrator path -o " + out + " --threads " + threads).code == 0);
    pictures.push_back(read_exr(out));
  }
  for (const char* channel : {"R", "G", "B", "Diffuse.R", "Variance.R"})
    CHECK(pictures[0].channels.at(channel) == pictures[1].channels.at(channel));
}

TEST_CASE("a closed room of albedo 1 comes to an end") {
  const std::string scene = closed_sphere(1.0, 0.2, "emission = [1.0, 1.0, 1.0]\n", "");
  CHECK(std::isfinite(mean(trace(scene, "", 1, {"render.spp=4"}), "R")));
}
