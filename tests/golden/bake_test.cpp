/// `pointgi bake` as a user starts it: files, messages, exit codes (interface.md).
#include "host/cloud/readers/ply.h"
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

TEST_CASE("bake writes a lit cloud that the program reads again, names it, and says what ran") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = folder.file("lit.ply");
  const Run run = run_program("bake " + scene + " -o " + out + " --stats " + folder.file("s.json") +
                              " --set radiosity.method=fmm"); // auto leaves out what a ball sends itself: nothing
  REQUIRE(run.code == 0);
  CHECK(run.out == out + "\n");
  CHECK_THAT(contents(out), Contains("format binary_little_endian 1.0") && Contains("property double z\n") &&
                                Contains("property uchar red\n") &&
                                Contains("property float scalar_radiosity_r\nproperty float scalar_radiosity_g\n"
                                         "property float scalar_radiosity_b\nend_header\n"));
  const auto stats = nlohmann::json::parse(std::ifstream(folder.file("s.json")));
  CHECK(stats["command"] == "bake");
  CHECK(stats.count("render") == 0);
  CHECK(stats["radiosity"]["iterations"] > 0);
  std::vector<std::string> ran;
  for (const auto& stage : stats["stages"]) {
    if (stage["ran"] == true) ran.push_back(stage["name"]);
    if (stage["name"] == "render") CHECK_THAT(stage["reason"].get<std::string>(), Contains("no camera"));
  }
  CHECK(ran == std::vector<std::string>{"scene", "cloud", "octree", "shafts", "vmap", "fmm", "bake"});
  CloudReport report;
  const PointCloud cloud = read_ply(out, {}, report);
  CHECK(cloud.size() == stats["scene"]["points"]);
  for (const Eigen::Vector3d& p : cloud.position)
    REQUIRE(p.norm() == Approx(0.8).margin(1e-6)); // a ball of radius 0.8, floats in a cube of 2
  CHECK(cloud.radius.size() == cloud.size());
  CHECK(cloud.normal.size() == cloud.size());
  const Run picture = run_program("render " + out + " --quiet --size 32x24 -o " + folder.file("lit.exr"));
  CHECK(picture.code == 0);
}

TEST_CASE("bake gives the same bytes again, on any number of threads; exposure changes the colours alone") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const auto bake = [&](const std::string& options) {
    const Run run = run_program("bake " + scene + " --quiet -o " + folder.file("x.ply") + options);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    return contents(folder.file("x.ply"));
  };
  const std::string once = bake(" --seed 3 --threads 1");
  CHECK(bake(" --seed 3 --threads 2") == once);
  const std::string dark = bake(" --seed 3 --exposure -2");
  REQUIRE(dark.size() == once.size());
  CHECK(dark != once);
  constexpr std::size_t point = 3 * 8 + 3 * 4 + 3 + 4 + 3 * 4, colours = 36; // bytes; where the colours begin
  const std::size_t first = once.find("end_header\n") + 11;
  REQUIRE((once.size() - first) % point == 0);
  std::size_t differ = 0;
  for (std::size_t i = first; i < once.size(); ++i) {
    const std::size_t at = (i - first) % point;
    if (at < colours || at >= colours + 3)
      REQUIRE(once[i] == dark[i]);
    else
      differ += once[i] != dark[i];
  }
  CHECK(differ > 1000);
}

TEST_CASE("bake of a scene with a mirror: its light without caustics, and the list of stages says so") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene());
  const Run run = run_program("bake " + scene + " -o " + folder.file("x.ply") + " --stats " + folder.file("s.json"));
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  const auto stats = nlohmann::json::parse(std::ifstream(folder.file("s.json")));
  std::size_t found = 0;
  for (const auto& stage : stats["stages"]) {
    if (stage["name"] != "photon") continue;
    CHECK(stage["ran"] == false);
    CHECK(stage["reason"] == "a lit cloud holds no caustics");
    ++found;
  }
  CHECK(found == 1);
  CHECK(stats.count("photons") == 0);
}

TEST_CASE("bake and render refuse before the work what they cannot do") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const std::string cloud = folder.write("three.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                                      "property float y\nproperty float z\nend_header\n"
                                                      "0 0 0\n1 0 0\n0 1 0\n");
  struct Case {
    std::string arguments;
    int code;
    std::string says;
  };
  const std::vector<Case> cases = {
      {"bake " + scene, 2, "-o"},
      {"bake -o " + folder.file("x.ply"), 2, "required"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --size 10x10", 2, "--size"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --expsure 1", 2, "did you mean \"--exposure\""},
      {"bake " + cloud + " -o " + cloud, 2, "is an input"},
      {"bake " + cloud + " -o " + folder.file("x.ply") + " --stats " + cloud, 2, "--stats"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --stats " + scene, 2, "is an input"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --stats " + folder.file("./x.ply"), 2, "-o writes, too"},
      {"render " + scene + " -o " + folder.file("x.exr") + " --stats " + scene, 2, "is an input"},
      {"render " + scene + " -o " + folder.file("x.exr") + " --stats " + folder.file("j") + " --trace " +
           folder.file("j"),
       2, "--stats writes, too"},
      {"render " + scene + " -o " + folder.file("x.exr") + " --stats " + folder.file("x.png"), 2, "-o writes, too"},
      {"bake " + folder.file("none.toml") + " -o " + folder.file("x.ply"), 3, "none.toml"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --device quantum", 4, "quantum"},
      {"bake " + scene + " -o " + folder.file("x.exr"), 5, ".ply"},
      {"bake " + scene + " -o " + folder.file("missing/x.ply"), 5, "missing"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --stats /dev/full", 5, "/dev/full"},
      {"bake " + scene + " -o " + folder.file("x.ply") + " --quality best", 2, "draft"},
  };
  for (const Case& c : cases) {
    const Run run = run_program(c.arguments);
    CAPTURE(c.arguments, run.err);
    CHECK(run.code == c.code);
    CHECK_THAT(run.err, Contains(c.says));
    CHECK_FALSE(std::filesystem::exists(folder.file("x.ply")));
  }
  CHECK(contents(cloud).size() > 100); // still there
  const Run bare = run_program("bake " + cloud + " --quiet -o " + folder.file("lit.ply"));
  CHECK(bare.code == 0);
}

TEST_CASE("bake without light between surfaces: direct light alone, or black, and a warning") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = folder.file("x.ply");
  const auto brightest = [&](const std::string& options) {
    const Run run = run_program("bake " + scene + " -o " + out + options);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK_THAT(run.err, Contains("warning: no light between surfaces"));
    CloudReport report;
    float most = 0.0f;
    for (const Eigen::Vector3f& colour : read_ply(out, {}, report).colour)
      most = std::max(most, colour.maxCoeff());
    return most;
  };
  CHECK(brightest(" --set radiosity.method=none") > 0.5f);
  CHECK(brightest(" --set light.0.power_w=[0,0,0]") == 0.0f);
}

TEST_CASE("bake --passes writes the cloud after each bounce, and the last is the result; other methods have none") {
  const TemporaryFolder folder;
  const std::string scene = folder.write(
      "corner.toml", std::string(small_scene()) +
                         "[[shape]]\ntype = \"quad\"\ncorner = [-2.0, -1.0, -2.0]\nedge_u = [0.0, 0.0, 4.0]\n"
                         "edge_v = [4.0, 0.0, 0.0]\nspacing = 0.2\nmaterial = \"grey\"\n");
  const std::string out = folder.file("lit.ply");
  const Run run = run_program("bake " + scene + " --quiet -o " + out +
                              " --passes --set radiosity.method=gather --set radiosity.passes=3");
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  const std::string first = contents(folder.file("lit.pass-001.ply")), last = contents(folder.file("lit.pass-003.ply"));
  CHECK(last == contents(out));
  CHECK(first != last);
  CHECK(!std::filesystem::exists(folder.file("lit.pass-004.ply")));
  const Run none = run_program("bake " + scene + " -o " + out + " --passes --set radiosity.method=fmm");
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("\"fmm\" has no passes") && Contains("radiosity.method=gather"));
}
