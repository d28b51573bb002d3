/// Light between surfaces as a user gets it, [radiosity], against what is known (truths.md §1) and the path tracer.
#include "tests/support/render.h"
#include "tests/support/run_program.h"
#include "tests/support/statistics.h"
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

std::string with_radiosity(const std::string& scene, const std::string& settings = "") {
  return scene + "[radiosity]\n" + settings;
}

/// The inside of a sphere of radius 1 with a point light of 4 pi W, 1 W/sr, in its middle, seen from within.
std::string lit_sphere(double albedo, double spacing) {
  const std::string rho = std::to_string(albedo);
  return "version = 1\n[render]\nsize = [24, 16]\nspp = 8\n[camera]\nposition = [0.3, 0.2, 0.4]\n"
         "look_at = [-0.5, 0.1, -1.0]\nfov_deg = 70.0\n[[material]]\nname = \"wall\"\ntype = \"diffuse\"\nalbedo = [" +
         rho + ", " + rho + ", " + rho +
         "]\n[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 1.0\ninward = true\nspacing = " +
         std::to_string(spacing) +
         "\nmaterial = \"wall\"\n[[light]]\ntype = \"point\"\nposition = [0.0, 0.0, 0.0]\n"
         "power_w = [12.566370614359172, 12.566370614359172, 12.566370614359172]\n";
}

/// A room open to the front, walls of two colours, a block on the floor, a lamp near the ceiling.
std::string room_with_block() {
  const auto quad = [](const char* corner, const char* u, const char* v, const char* material) {
    return std::string("[[shape]]\ntype = \"quad\"\ncorner = [") + corner + "]\nedge_u = [" + u + "]\nedge_v = [" + v +
           "]\nspacing = 0.06\nmaterial = \"" + material + "\"\n";
  };
  return "version = 1\n[render]\nsize = [40, 40]\nspp = 64\n[camera]\nposition = [0.0, 1.0, 4.2]\n"
         "look_at = [0.0, 1.0, 0.0]\nfov_deg = 32.0\n"
         "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nalbedo = [0.75, 0.75, 0.75]\n"
         "[[material]]\nname = \"red\"\ntype = \"diffuse\"\nalbedo = [0.7, 0.1, 0.1]\n"
         "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0.0, 0.0, 0.0]\nemission = [12.0, 11.0, 9.0]\n" +
         quad("-1, 0, -1", "0, 0, 2", "2, 0, 0", "white") + quad("-1, 2, -1", "2, 0, 0", "0, 0, 2", "white") +
         quad("-1, 0, -1", "2, 0, 0", "0, 2, 0", "white") + quad("-1, 0, -1", "0, 2, 0", "0, 0, 2", "red") +
         quad("1, 0, -1", "0, 0, 2", "0, 2, 0", "white") + quad("-0.3, 1.97, -0.3", "0.6, 0, 0", "0, 0, 0.6", "lamp") +
         "[[shape]]\ntype = \"box\"\nmin = [-0.2, 0.0, -0.4]\nmax = [0.5, 0.8, 0.2]\nspacing = 0.05\n"
         "material = \"white\"\n";
}

} // namespace

TEST_CASE("a point light in a closed sphere: L = rho I / (pi R^2 (1 - rho)), nearer with closer points") {
  for (const double albedo : {0.5, 0.8}) {
    const double truth = albedo / (pi * (1.0 - albedo));
    double before = INFINITY;
    for (const double spacing : {0.12, 0.06}) {
      CAPTURE(albedo, spacing);
      const Picture picture = render_text(with_radiosity(lit_sphere(albedo, spacing), "tolerance = 1e-4\n"));
      const double error = std::fabs(mean(picture, "G") / truth - 1.0);
      // 1 % is the bound of truths.md; what the V-map leaves out is less, and each bounce repeats it.
      CHECK(error < (spacing < 0.1 ? 0.02 : 0.04) / (1.0 - albedo) * 0.5);
      CHECK(error < before + 0.005); // the share that the V-map decides does not fall with the spacing
      before = error;
      CHECK(mean(picture, "Direct.G") == Approx(albedo / pi).epsilon(0.01));
      CHECK(largest(picture, "R") < 1.15 * truth); // no speckle
    }
  }
}

TEST_CASE("a room with a block and a lamp: the picture of the path tracer, colours that bleed", "[long]") {
  const Picture fast = render_text(with_radiosity(room_with_block()));
  const Picture truth = render_text(room_with_block(), [](RenderOptions& options) {
    options.integrator = "path";
    options.spp = 1024;
  });
  const LightTest test = test_of_light(fast, truth, 0.02); // V-map 1 %, light samples of 64 rays 1 %
  CAPTURE(test.part, test.off);
  CHECK(test.p > significance);
  CHECK(mean(fast, "Diffuse.R") > 1.05 * mean(fast, "Diffuse.G")); // off the red wall
  double together = 0.0;
  for (std::size_t i = 0; i < fast.channels.at("R").size(); ++i)
    together = std::max<double>(together, std::fabs(fast.channels.at("R")[i] - fast.channels.at("Direct.R")[i] -
                                                    fast.channels.at("Diffuse.R")[i]));
  CHECK(together < 1e-4);
}

TEST_CASE("radiosity.method = direct: no V-map, a ray a pair, the picture of fmm") {
  const TemporaryFolder folder;
  const std::string scene = with_radiosity(lit_sphere(0.5, 0.15)), stats = folder.file("stats.json");
  const auto diffuse_by = [&](const char* method) {
    return mean(render_text(scene,
                            [&](RenderOptions& options) {
                              options.overrides = {std::string("radiosity.method=") + method};
                              options.stats_file = stats;
                            }),
                "Diffuse.G");
  };
  const auto read_stats = [&] { return nlohmann::json::parse(std::ifstream(stats)); };
  const double by_fmm = diffuse_by("fmm");
  CHECK(read_stats()["radiosity"]["rays"] == read_stats()["vmap"]["rays"]);
  CHECK(diffuse_by("direct") == Approx(by_fmm).epsilon(0.01)); // what the V-map may lose
  const auto found = read_stats();
  CHECK(found["radiosity"]["method"] == "direct");
  CHECK(found["radiosity"]["converged"] == true);
  CHECK(found["radiosity"]["iterations"] > 3);
  const double points = found["scene"]["points"], rays = found["radiosity"]["rays"];
  CHECK(rays == Approx(points * (points - 1) / 2).epsilon(0.001)); // inside a sphere all face all
  CHECK(found.count("vmap") == 0);
  for (const auto& stage : found["stages"]) {
    if (stage["name"] == "vmap") CHECK_THAT(std::string(stage["reason"]), Catch::Contains("a ray for every pair"));
    if (stage["name"] == "direct") CHECK(stage["ran"] == true);
    CHECK(stage["name"] != "fmm");
  }
  CHECK(std::count_if(found["stages"].begin(), found["stages"].end(),
                      [](const auto& stage) { return stage["name"] == "direct"; }) == 1);
}

TEST_CASE("direct_light = radiosity: the thesis' picture without shadow rays, near that with them", "[long]") {
  // A point light too: it enters by shadow rays at the points, in both modes.
  const std::string scene =
      room_with_block() + "[[light]]\ntype = \"point\"\nposition = [0.0, 1.2, 0.8]\npower_w = [9.0, 9.0, 9.0]\n";
  const TemporaryFolder folder;
  const std::string stats = folder.file("stats.json");
  const auto render = [&](const std::vector<std::string>& set) {
    const Picture picture = render_text(scene, [&](RenderOptions& options) {
      options.overrides = set;
      options.stats_file = stats;
    });
    return std::make_pair(picture, nlohmann::json::parse(std::ifstream(stats)));
  };
  const auto [with_rays, rays_stats] = render({});
  const auto [thesis, thesis_stats] = render({"radiosity.direct_light=radiosity"});
  const auto [dark, dark_stats] = render({"light.0.power_w=[0,0,0]", "material.lamp.emission=[0,0,0]"});
  // Shadows and the lamp's light are as coarse as the splats: 0.06 in a room of 2, an error of both signs.
  for (const char* channel : {"R", "G", "B"})
    CHECK(mean(thesis, channel) == Approx(mean(with_rays, channel)).epsilon(0.03));
  // Eye rays, and what blending asks: those of a picture in which nothing shines.
  CHECK(thesis_stats["render"]["rays"] == dark_stats["render"]["rays"]);
  CHECK(rays_stats["render"]["rays"] > 2 * thesis_stats["render"]["rays"].get<std::uint64_t>());
  CHECK(thesis_stats["radiosity"]["direct_light"] == "radiosity");
  // Direct is what shines by itself, Diffuse all the rest.
  const auto &direct = thesis.channels.at("Direct.G"), &albedo = thesis.channels.at("Albedo.G");
  double lamp = 0.0;
  for (std::size_t i = 0; i < direct.size(); ++i) {
    lamp = std::max<double>(lamp, direct[i]);
    if (albedo[i] > 0.745f) CHECK(direct[i] == 0.0f); // all 64 samples on a white wall
    CHECK(thesis.channels.at("G")[i] == Approx(direct[i] + thesis.channels.at("Diffuse.G")[i]).margin(1e-5));
  }
  CHECK(lamp > 0.0);
  CHECK(mean(thesis, "Diffuse.G") > mean(with_rays, "Diffuse.G"));
}

TEST_CASE("radiosity.vmap = thesis: one ray a pair of clusters, darker, and nearly the picture") {
  const TemporaryFolder folder;
  const std::string stats = folder.file("stats.json");
  const auto render = [&](const char* vmap) {
    const Picture picture = render_text(room_with_block(), [&](RenderOptions& options) {
      options.overrides = {std::string("radiosity.vmap=") + vmap};
      options.stats_file = stats;
    });
    return std::make_pair(mean(picture, "Diffuse.G"), nlohmann::json::parse(std::ifstream(stats)));
  };
  const auto [fractions, fractions_stats] = render("fractions");
  const auto [thesis, thesis_stats] = render("thesis");
  // method.md §3: 3.7 % of error, -2.5 % of bias in a closed room, and each bounce repeats it.
  CHECK(thesis == Approx(fractions).epsilon(0.1));
  CHECK(thesis_stats["vmap"]["rays"].get<double>() <= thesis_stats["vmap"]["pairs_tested"].get<double>());
  CHECK(fractions_stats["vmap"]["rays"].get<double>() > fractions_stats["vmap"]["pairs_tested"].get<double>());
}

TEST_CASE("radiosity runs where something shines, is kept, and gives the same bits again") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("room.toml", with_radiosity(lit_sphere(0.5, 0.15)));
  const std::string cache = "POINTGI_CACHE_DIR=" + folder.file("cache");
  const Run first =
      run_program("render " + scene + " --set radiosity.method=fmm --threads 1 -o " + folder.file("a.exr"), cache);
  REQUIRE(first.code == 0);
  CHECK_THAT(first.err, Catch::Contains("radiosity: ") && !Catch::Contains("kept from an earlier run"));
  const Run second =
      run_program("render " + scene + " --set radiosity.method=fmm --threads 2 -o " + folder.file("b.exr"), cache);
  REQUIRE(second.code == 0);
  CHECK_THAT(second.err, Catch::Contains("V-map: kept from an earlier run"));
  CHECK(read_exr(folder.file("a.exr")).channels == read_exr(folder.file("b.exr")).channels);
  // Made again by two threads, not kept.
  const Run anew = run_program("render " + scene + " --set radiosity.method=fmm --threads 2 -o " + folder.file("d.exr"),
                               "POINTGI_CACHE_DIR=" + folder.file("another_cache"));
  REQUIRE(anew.code == 0);
  CHECK_THAT(anew.err, !Catch::Contains("kept from an earlier run"));
  CHECK(read_exr(folder.file("a.exr")).channels == read_exr(folder.file("d.exr")).channels);
  const std::string dark = folder.write("dark.toml", with_radiosity(room_with_block()));
  const Run none =
      run_program("render " + dark + " --set material.2.emission=[0,0,0] -o " + folder.file("c.exr"), cache);
  CHECK(none.code == 0);
  CHECK_THAT(none.err, Catch::Contains("no light and no emission"));
  const Run refused =
      run_program("render " + scene + " --set radiosity.direct_light=radiosity --set radiosity.method=none", cache);
  CHECK(refused.code == 3);
  CHECK_THAT(refused.err, Catch::Contains("direct_light") && Catch::Contains("method is \"none\""));
  const Run unknown = run_program("render " + scene + " --set radiosity.method=progressive", cache);
  CHECK(unknown.code == 3);
  CHECK_THAT(unknown.err,
             Catch::Contains("expected \"auto\", \"none\", \"fmm\"") && Catch::Contains("found \"progressive\""));
}
