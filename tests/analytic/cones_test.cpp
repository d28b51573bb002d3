/// radiosity.method = "cones" as a user gets it, at points and at pixels, against what is known and the path tracer.
#include "tests/support/run_program.h"
#include "tests/support/scene_parts.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr double pi = 3.14159265358979323846;

const char* by_cones(bool at_pixels) {
  return at_pixels ? "[radiosity]\nmethod = \"cones\"\nat = \"pixels\"\n" : "[radiosity]\nmethod = \"cones\"\n";
}

/// The inside of a sphere of radius 1 with a point light of 1 W/sr in its middle.
std::string lit_sphere(double albedo) {
  return head("0.3, 0.2, 0.4", "-0.5, 0.1, -1.0", 70.0, 8, "[24, 16]") +
         material("wall", "diffuse", "albedo = " + grey(albedo)) +
         "[[shape]]\ntype = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1.0\ninward = true\nspacing = 0.08\n"
         "material = \"wall\"\n[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\npower_w = " +
         grey(4.0 * pi) + "\n";
}

/// A room open to the front, a block in it, a light near the ceiling, and a floor of material "floor".
std::string room(const std::string& floor) {
  return head("0.1, 1.0, 3.4", "0.0, 0.6, 0.0", 38.0, 32, "[32, 24]") +
         material("white", "diffuse", "albedo = [0.7, 0.7, 0.7]") +
         material("red", "diffuse", "albedo = [0.7, 0.1, 0.1]") +
         material("green", "diffuse", "albedo = [0.1, 0.6, 0.1]") + floor +
         quad("-1, 0, -1", "0, 0, 2", "2, 0, 0", "floor", 0.05) +
         quad("-1, 2, -1", "2, 0, 0", "0, 0, 2", "white", 0.05) +
         quad("-1, 0, -1", "2, 0, 0", "0, 2, 0", "white", 0.05) + quad("-1, 0, -1", "0, 2, 0", "0, 0, 2", "red", 0.05) +
         quad("1, 0, -1", "0, 0, 2", "0, 2, 0", "green", 0.05) +
         box("0.1, 0.0, -0.6", "0.6, 0.7, -0.1", "white", 0.04) +
         "[[light]]\ntype = \"point\"\nposition = [0.0, 1.7, 0.3]\npower_w = [60, 60, 60]\n"
         "[caustics]\nphotons = 0\n";
}

/// Mean over the lower half of the picture.
double mean_of_floor(const Picture& picture, const std::string& channel) {
  const std::vector<float>& values = picture.channels.at(channel);
  double sum = 0.0;
  for (std::size_t i = values.size() / 2; i < values.size(); ++i)
    sum += double{values[i]};
  return 2.0 * sum / static_cast<double>(values.size());
}

} // namespace

TEST_CASE("cones: a point light in a closed sphere, L = rho I / (pi R^2 (1 - rho))", "[long]") {
  for (const bool at_pixels : {false, true})
    for (const double albedo : {0.5, 0.9}) {
      CAPTURE(at_pixels, albedo);
      const Picture picture = render_text(lit_sphere(albedo) + by_cones(at_pixels) + "tolerance = 1e-4\n");
      // What is lost at a bounce, 0.1 %, and the splats' own error of 1 %.
      const double truth = albedo / (pi * (1.0 - albedo));
      CHECK(mean(picture, "G") == Approx(truth).epsilon(0.02));
      CHECK(largest(picture, "G") < 1.1 * truth);
    }
}

TEST_CASE("cones: a room with a bright spot under its ceiling is the path tracer's to a tenth", "[long]") {
  const std::string scene = room(material("floor", "diffuse", "albedo = [0.2, 0.2, 0.2]"));
  const Picture truth = trace(scene, "", 256);
  for (const bool at_pixels : {false, true}) {
    const Picture picture = render_text(scene + by_cones(at_pixels));
    for (const char* channel : {"R", "G", "B"}) {
      CAPTURE(at_pixels, channel);
      CHECK(mean(picture, channel) == Approx(mean(truth, channel)).epsilon(0.1)); // 20 % is asked for
    }
    // Nine directions a point miss parts of the spot or count them twice.
    CHECK(mean(picture, "Diffuse.R") == Approx(mean(truth, "Diffuse.R")).epsilon(0.12));
    CHECK(mean(picture, "Diffuse.R") > 1.1 * mean(picture, "Diffuse.G")); // off the red wall
  }
}

TEST_CASE("a lobe's cone finds the blurred reflection that the path tracer finds", "[long]") {
  const std::string gloss =
      GENERATE(std::string("phong\"\nalbedo = [0.2, 0.2, 0.2]\nspecular = [0.6, 0.6, 0.6]\nexponent = 400"),
               std::string("conductor\"\nreflectance = [0.8, 0.8, 0.8]\nroughness = 0.1"));
  CAPTURE(gloss);
  const std::string scene = room("[[material]]\nname = \"floor\"\ntype = \"" + gloss + "\n");
  const Picture cones = render_text(scene + by_cones(true));
  // Light that the floor throws onto the walls is caustics', which the cones do not gather.
  const Picture truth = trace(scene, "LSE,LD+SE", 400), rays = render_text(scene + by_cones(false));
  for (const char* channel : {"Specular.R", "Specular.G", "Specular.B"}) {
    CAPTURE(channel);
    CHECK(mean_of_floor(cones, channel) == Approx(mean_of_floor(truth, channel)).epsilon(0.1));
  }
  // A cone a sample has no noise of its own, and no ray goes on.
  CHECK(mean(cones, "Specular.G") == Approx(mean(rays, "Specular.G")).epsilon(0.1));
}

TEST_CASE("cones at pixels: direct light by radiosity, the same bits again, and points alone in a baked cloud",
          "[long]") {
  const std::string scene = room(material("floor", "diffuse", "albedo = [0.2, 0.2, 0.2]")) + by_cones(true);
  const auto diffuse = [&](const char* direct_light) {
    const Picture picture = render_text(scene + "direct_light = \"" + direct_light + "\"\n");
    return mean(picture, "Diffuse.G") + mean(picture, "Direct.G");
  };
  // The direct light is interpolated between splats 0.05 apart.
  CHECK(diffuse("radiosity") == Approx(diffuse("shadow_rays")).epsilon(0.03));
  const TemporaryFolder folder;
  const std::string file = folder.write("room.toml", scene);
  const std::string cache = "POINTGI_CACHE_DIR=" + folder.file("cache");
  for (const char* threads : {"1", "2"}) {
    const Run run = run_program("render " + file + " --spp 4 --threads " + threads + " -o " +
                                    folder.file(std::string(threads) + ".exr"),
                                cache);
    REQUIRE(run.code == 0);
    CHECK_THAT(run.err, Catch::Contains("voxels that hold surface"));
  }
  CHECK(read_exr(folder.file("1.exr")).channels == read_exr(folder.file("2.exr")).channels);
  const Run baked = run_program("bake " + file + " -o " + folder.file("lit.ply"), cache);
  CHECK(baked.code == 0);
  CHECK_THAT(baked.err, Catch::Contains("radiosity.at = \"pixels\" has no effect"));
}
