/// What `pointgi info` tells of a picture's cost, and what `render` and `bake` refuse before the work.
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// The line of a table that begins with this word; empty: there is none.
std::string line_of(const std::string& text, const std::string& word) {
  const std::size_t at = text.find("\n  " + word + " ");
  return at == std::string::npos ? std::string() : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

} // namespace

TEST_CASE("info tells the stages of a picture, why they run or not, their seconds and memory") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene());
  const Run run = run_program("info " + scene + " --size 64x48 --spp 8 --set radiosity.method=fmm");
  CAPTURE(run.out, run.err);
  REQUIRE(run.code == 0);
  for (const char* stage : {"scene", "cloud", "octree", "vmap", "fmm", "normals", "photon", "render", "image", "all"})
    CHECK(!line_of(run.out, stage).empty());
  CHECK_THAT(line_of(run.out, "render"), Contains("64 x 48 pixels of 8 samples") && Contains("MiB"));
  CHECK_THAT(line_of(run.out, "vmap"), Contains("radiosity.method = \"fmm\""));
  CHECK_THAT(line_of(run.out, "photon"), Contains("400000 photons"));
  CHECK_THAT(line_of(run.out, "all"), Contains("MiB that the device has"));
  const Run plain = run_program("info " + folder.write("ball.toml", small_scene()) + " --set radiosity.method=none");
  REQUIRE(plain.code == 0);
  CHECK_THAT(line_of(plain.out, "vmap"), Contains("direct light only"));
  CHECK_THAT(line_of(plain.out, "photon"), Contains("no specular material"));
}

TEST_CASE("info tells nothing of cost where it is not asked to, or where there is no device") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const Run quick = run_program("info " + scene + " --no-estimate", "POINTGI_DEVICE=quantum");
  CHECK(quick.code == 0);
  CHECK_THAT(quick.out, Contains("octree") && !Contains("picture"));
  const Run none = run_program("info " + scene, "OCL_ICD_VENDORS=" + folder.file("none"));
  CAPTURE(none.err);
  CHECK(none.code == 0);
  CHECK_THAT(none.out, Contains("octree") && Contains("not estimated: there is no OpenCL device"));
  CHECK(run_program("info " + scene, "POINTGI_DEVICE=quantum").code == 4);
}

TEST_CASE("light that the device's memory cannot hold is refused with what would fit") {
  const TemporaryFolder folder;
  // 13,000 points: pairs take 10 MiB.
  std::string text = small_scene();
  text.replace(text.find("spacing = 0.05"), 14, "spacing = 0.025");
  const std::string scene = folder.write("ball.toml", text), picture = " --quiet -o " + folder.file("x.exr");
  const std::string small = "POINTGI_DEVICE_MEMORY=12";
  const Run direct = run_program("render " + scene + picture + " --set radiosity.method=direct", small);
  CAPTURE(direct.err);
  CHECK(direct.code == 6);
  CHECK_THAT(direct.err, Contains("radiosity.method = \"direct\" of ") && Contains("needs ") &&
                             Contains(" MiB left of 12 MiB") && Contains("radiosity.method = \"directions\"") &&
                             Contains("shape.0.spacing = ") && Contains("which keeps about"));
  CHECK_FALSE(std::filesystem::exists(folder.file("x.exr")));
  const Run bake = run_program("bake " + scene + " --quiet -o " + folder.file("x.ply") +
                                   " --set radiosity.method=gather --set radiosity.visibility_cache=true",
                               small);
  CHECK(bake.code == 6);
  CHECK_THAT(bake.err, Contains("radiosity.method = \"gather\"") && Contains("radiosity.visibility_cache = false"));
  const Run cones =
      run_program("render " + scene + picture + " --set radiosity.method=cones --set radiosity.voxels=128",
                  "POINTGI_DEVICE_MEMORY=90");
  CHECK(cones.code == 6);
  CHECK_THAT(cones.err, Contains("radiosity.voxels = 64"));
  const Run info = run_program("info " + scene + " --set radiosity.method=direct", small);
  CHECK(info.code == 0);
  CHECK_THAT(info.out, Contains("render would refuse: ") && Contains("radiosity.method = \"directions\""));
  // What the text says is so.
  const Run fits = run_program("render " + scene + picture + " --size 16x12 --set radiosity.method=directions", small);
  CAPTURE(fits.err);
  CHECK(fits.code == 0);
}

TEST_CASE("photons and octrees that the device's memory cannot hold are refused with what would fit") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene()),
                    picture = " --quiet -o " + folder.file("x.exr");
  const Run photons =
      run_program("render " + scene + picture + " --set caustics.photons=4000000", "POINTGI_DEVICE_MEMORY=40");
  CAPTURE(photons.err);
  CHECK(photons.code == 6);
  CHECK_THAT(photons.err, Contains("caustics.photons = 4000000 needs ") && Contains("set caustics.photons = "));
  std::string text = small_scene();
  text.replace(text.find("spacing = 0.05"), 14, "spacing = 0.01");
  const Run octree = run_program("render " + folder.write("fine.toml", text) + picture, "POINTGI_DEVICE_MEMORY=4");
  CAPTURE(octree.err);
  CHECK(octree.code == 6);
  CHECK_THAT(octree.err, Contains("the octree of ") && Contains("shape.0.spacing = "));
  const Run wrong = run_program("devices", "POINTGI_DEVICE_MEMORY=lots");
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.err, Contains("POINTGI_DEVICE_MEMORY=lots") && Contains("MiB"));
}
