/// render --denoise, with a stand-in for the library (tests/fakes/oidn.cpp), and with the real one where there is one.
#include "host/image/picture_writer.h"
#include "tests/support/fake_oidn.h"
#include "tests/support/run_program.h"
#include "tests/support/scans.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <dlfcn.h>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

const std::vector<std::string> guides{
    "Denoise.Albedo.R",   "Denoise.Albedo.G",   "Denoise.Albedo.B",   "Denoise.N.X", "Denoise.N.Y", "Denoise.N.Z",
    "Denoise.Emission.R", "Denoise.Emission.G", "Denoise.Emission.B", "Noisy.R",     "Noisy.G",     "Noisy.B"};
const std::vector<std::string> lights{"Direct.", "Diffuse.", "Specular.", "Caustic."};
const std::string few_photons = " --set caustics.photons=2000 ";

/// R, G and B are the sum of the lights, every value is finite, and the guides are there.
void check_denoised(const Picture& picture) {
  for (const std::string& name : guides)
    CHECK(picture.channels.count(name) == 1);
  for (const char colour : {'R', 'G', 'B'}) {
    std::vector<double> sum(picture.channels.at("R").size());
    for (const std::string& light : lights) {
      const auto at = picture.channels.find(light + colour);
      if (at == picture.channels.end()) continue;
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += double{at->second[i]};
    }
    const std::vector<float>& all = picture.channels.at(std::string(1, colour));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < sum.size(); ++i)
      wrong += std::isfinite(all[i]) && std::abs(double{all[i]} - sum[i]) <= 1e-6 * sum[i] ? 0 : 1;
    CHECK(wrong == 0);
  }
}

bool is_whole(const Picture& picture) {
  const std::vector<float>& red = picture.channels.at("R");
  return std::any_of(red.begin(), red.end(), [](float value) { return value > 0.0f; });
}

} // namespace

TEST_CASE("render --denoise denoises each light and keeps what was rendered", "[long]") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene());
  const std::string integrator = GENERATE("pointgi", "path");
  const std::string common = "render " + scene + few_photons + "--quiet --integrator " + integrator + " -o ";
  REQUIRE(run_program(common + folder.file("plain.exr")).code == 0);
  const Run run = run_program(common + folder.file("x.exr") + " --denoise --stats " + folder.file("s.json"));
  INFO(run.err);
  REQUIRE(run.code == 0);
  CHECK(run.out == folder.file("x.exr") + "\n" + folder.file("x.png") + "\n");
  const Picture plain = read_exr(folder.file("plain.exr")), picture = read_exr(folder.file("x.exr"));
  check_denoised(picture);
  CHECK(picture.channels.size() == plain.channels.size() + guides.size());
  for (const auto& [name, values] : plain.channels) {
    CAPTURE(name);
    const bool is_light =
        name.size() == 1
            ? name != "A" && name != "Z"
            : std::any_of(lights.begin(), lights.end(), [&, &of = name](const auto& l) { return of.rfind(l, 0) == 0; });
    if (!is_light) CHECK(picture.channels.at(name) == values);
    if (name.size() == 1 && is_light) CHECK(picture.channels.at("Noisy." + name) == values);
    if (name == "R") CHECK(picture.channels.at(name) != values);
  }
  CHECK(plain.channels.count("Denoise.N.X") == 0);
  CHECK(plain.attributes.text.count("pointgi/denoiser") == 0);
  CHECK(picture.attributes.text.at("pointgi/denoiser") == "Open Image Denoise 2.3.7");
  CHECK(contents(folder.file("plain.png")) != contents(folder.file("x.png")));

  const auto stats = json_of(folder.file("s.json"));
  CHECK(stats["denoise"]["version"] == "2.3.7");
  CHECK(stats["denoise"]["library"] == fake_oidn("works") + "/libOpenImageDenoise.so.2");
  CHECK(stats["denoise"]["failed"] == false);
  CHECK(stats["denoise"]["seconds"] > 0.0);
  const std::vector<std::string> ran = names_of(stats["stages"], true);
  REQUIRE(ran.size() > 3);
  CHECK(std::vector<std::string>(ran.end() - 3, ran.end()) == std::vector<std::string>{"render", "denoise", "image"});
}

TEST_CASE("without the library render --denoise ends before there is any work") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = folder.write("x.exr", "older");
  const auto refused = [&](const std::string& before) {
    const Run run = run_program("render " + scene + " --denoise -o " + out, before);
    CHECK(run.code == 2);
    CHECK(contents(out) == "older");
    CHECK(run.err.rfind("error: --denoise: ", 0) == 0); // before the log tells of a device
    CHECK_THAT(run.err, Contains("POINTGI_OIDN"));
    return run.err;
  };
  if (dlopen("libOpenImageDenoise.so.2", RTLD_LAZY) == nullptr &&
      dlopen("libOpenImageDenoise.so", RTLD_LAZY) == nullptr)
    CHECK_THAT(refused("env -u POINTGI_OIDN"), Contains("Intel Open Image Denoise was not found"));
  CHECK_THAT(refused("POINTGI_OIDN=/nowhere"), Contains("POINTGI_OIDN names /nowhere, which is not there"));
  CHECK_THAT(refused("POINTGI_OIDN=" + fake_oidn("version1")), Contains("too old"));
  CHECK_THAT(refused("POINTGI_OIDN=" + fake_oidn("works") + " FAKE_OIDN=old"), Contains("too old"));
  CHECK_THAT(refused("POINTGI_OIDN=" + fake_oidn("works") + " FAKE_OIDN=crash"), Contains("crashes"));
}

TEST_CASE("where the library fails at the end, the picture is written as it was rendered", "[long]") {
  const FakeOidn fake("late");
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const std::string how = GENERATE("", " --progressive");
  REQUIRE(run_program("render " + scene + " --quiet -o " + folder.file("plain.exr")).code == 0);
  const Run run = run_program("render " + scene + how + " --denoise -o " + folder.file("x.exr"));
  CHECK(run.code == 4);
  CHECK_THAT(run.err, Contains("x.exr is written as it was rendered") && Contains("the weights are gone"));
  const Picture picture = read_exr(folder.file("x.exr")), plain = read_exr(folder.file("plain.exr"));
  CHECK(picture.channels.at("R") == plain.channels.at("R"));
  CHECK(picture.channels.at("Direct.B") == plain.channels.at("Direct.B"));
}

TEST_CASE("a growing picture ends as the one that is denoised at once", "[long]") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene());
  const std::string common = "render " + scene + few_photons + "--spp 40 --denoise --quiet -o ";
  REQUIRE(run_program(common + folder.file("a.exr")).code == 0);
  REQUIRE(run_program(common + folder.file("b.exr") + " --progressive --stats " + folder.file("s.json")).code == 0);
  const Picture a = read_exr(folder.file("a.exr")), b = read_exr(folder.file("b.exr"));
  check_denoised(b);
  CHECK(a.channels == b.channels);
  const auto stats = json_of(folder.file("s.json"));
  CHECK(reason_of(stats["stages"], "denoise").empty());
}

TEST_CASE("pictures of a given time or error are denoised, and those that are interrupted", "[long]") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  const std::string lit = std::string(small_scene()) + "[environment]\nradiance = [1.0, 1.0, 1.0]\n";
  const std::string scene = folder.write("ball.toml", lit), out = folder.file("x.exr");
  REQUIRE(run_program("render " + scene + " --time 2 --denoise -o " + out).code == 0);
  check_denoised(read_exr(out));
  const std::string stats = folder.file("s.json");
  REQUIRE(run_program("render " + scene + " --error 0.5 --denoise -o " + out + " --stats " + stats).code == 0);
  check_denoised(read_exr(out));
  CHECK(json_of(stats)["denoise"]["version"] == "2.3.7");
  std::filesystem::remove(out);
  const std::string slow = "render " + scene + " --progressive --denoise --size 200x100 --spp 65536 -o " + out;
  for (const char* seconds : {"4", "16", "64"}) { // until the first picture is there, on any machine
    const Run run = run_program(slow, std::string("timeout --foreground --preserve-status -s INT ") + seconds);
    CHECK(run.code == 130);
    if (std::filesystem::exists(out)) break;
  }
  const Picture picture = read_exr(out);
  check_denoised(picture);
  CHECK(picture.height == 100);
  CHECK(is_whole(picture));
}

TEST_CASE("windows, single pixels and scenes without light are denoised", "[long]") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene()), out = folder.file("x.exr");
  const Variable log("FAKE_OIDN_LOG", folder.file("log").c_str());
  REQUIRE(run_program("render " + scene + few_photons + "--denoise --quiet --pixelbounds 10,27,5,16 -o " + out).code ==
          0);
  const Picture part = read_exr(out);
  CHECK(part.width == 17);
  CHECK(part.height == 11);
  CHECK(part.full_width == 40);
  check_denoised(part);
  CHECK_THAT(contents(folder.file("log")), Contains("output:17x11+0,12,204:3"));
  REQUIRE(run_program("render " + scene + few_photons + "--denoise --quiet --size 1x1 -o " + out).code == 0);
  check_denoised(read_exr(out));
  std::string dark = mirror_scene();
  dark.resize(dark.find("[[light]]"));
  const std::string unlit = folder.write("dark.toml", dark);
  REQUIRE(run_program("render " + unlit + " --denoise --quiet -o " + out).code == 0);
  const Picture black = read_exr(out);
  check_denoised(black);
  CHECK(!is_whole(black));
}

TEST_CASE("the real library takes noise out of a picture") {
  const char* const named = std::getenv("POINTGI_OIDN");
  if (named == nullptr || *named == '\0') {
    WARN("skipped: POINTGI_OIDN names no Open Image Denoise");
    something_skipped = true;
    return;
  }
  const TemporaryFolder folder;
  // The ball in a corner under the sky: light comes by way of the walls.
  const std::string corner = std::string(small_scene()) +
                             "[environment]\nradiance = [1.0, 1.0, 1.0]\n"
                             "[[shape]]\ntype = \"box\"\nmin = [-2.0, -0.9, -1.5]\nmax = [2.0, 2.0, 4.0]\n"
                             "inward = true\nspacing = 0.1\nmaterial = \"grey\"\n";
  const std::string scene = folder.write("ball.toml", corner), out = folder.file("x.exr");
  const std::string common = "render " + scene + " --integrator path --quiet ";
  const std::string sized = common + "--size 64x48 ";
  REQUIRE(run_program(sized + "--spp 1024 --seed 2 -o " + folder.file("truth.exr")).code == 0);
  const Run run = run_program(sized + "--spp 4 --denoise -o " + out);
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Picture truth = read_exr(folder.file("truth.exr")), picture = read_exr(out);
  check_denoised(picture);
  const auto error = [&](const std::string& prefix) {
    double sum = 0.0;
    for (const char colour : {'R', 'G', 'B'})
      for (std::size_t i = 0; i < truth.channels.at("R").size(); ++i)
        sum += std::pow(
            double{picture.channels.at(prefix + colour)[i]} - double{truth.channels.at(std::string(1, colour))[i]}, 2);
    return sum;
  };
  CHECK(error("") < 0.5 * error("Noisy."));
  REQUIRE(run_program(common + "--spp 1 --size 1x1 --denoise -o " + out).code == 0);
  check_denoised(read_exr(out));
}
