/// A scene runs the stages that it needs, and its kernels are built with no more (method.md §7).
#include "host/image/picture_writer.h"
#include "tests/support/run_program.h"
#include "tests/support/stats_file.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

TEST_CASE("a scene without specular surfaces runs no stage and builds no kernel for them") {
  const TemporaryFolder folder;
  struct Found {
    nlohmann::json stats;
    std::string options; ///< of all programs
    std::set<std::string> files, channels;
  };
  const auto render = [&](const std::string& name, const std::string& text) {
    const std::string scene = folder.write(name + ".toml", text), out = folder.file(name);
    const Run run = run_program("render " + scene + " --quiet -o " + out + ".exr --stats " + out + ".json" +
                                " --dump-kernels " + out);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    Found found{json_of(out + ".json"), {}, {}, {}};
    for (const auto& entry : std::filesystem::directory_iterator(out)) {
      std::ifstream file(entry.path());
      std::string first;
      std::getline(file, first);
      found.options += first + "\n";
      const std::string stem = entry.path().stem().string(); // "render_shade-1a2b3c4d"
      found.files.insert(stem.substr(0, stem.rfind('-')));
    }
    for (const auto& [channel, values] : read_exr(out + ".exr").channels)
      found.channels.insert(channel);
    return found;
  };
  // The same words are looked for where they must be, so that none of them can be a wrong one.
  const auto check = [](const Found& found, bool there) {
    CHECK((reason_of(found.stats["stages"], "normals") == "no specular material") == !there);
    CHECK((reason_of(found.stats["stages"], "photon") == "no specular material") == !there);
    CHECK(found.stats.count("photons") == (there ? 1 : 0));
    CHECK(found.stats["kernels"].count("trace_photons") == (there ? 1 : 0));
    CHECK(found.files.count("photon_trace_photons") == (there ? 1 : 0));
    for (const char* option : {"HAS_SPECULAR", "HAS_CAUSTICS", "GATHER_MOST"})
      CHECK((found.options.find(option) != std::string::npos) == there);
    for (const char* channel : {"Specular.R", "Caustic.R"})
      CHECK(found.channels.count(channel) == (there ? 1 : 0));
  };
  const std::string photons = "[caustics]\nphotons = 2000\n"; // asked for, but there is nothing to send them to
  // A ball sends itself nothing: the planner would leave out what else is looked for below.
  const Found diffuse = render("diffuse", small_scene() + photons + "[radiosity]\nmethod = \"fmm\"\n");
  check(diffuse, false);
  for (const char* option : {"HAS_TRANSMISSION", "HAS_LOBES", "WITH_MIRROR"})
    CHECK_THAT(diffuse.options, !Contains(option));
  CHECK_THAT(diffuse.options, Contains("HAS_RADIOSITY")); // nothing but the specular part is left out
  check(render("mirror", mirror_scene() + photons), true);
}

TEST_CASE("light that goes round between surfaces and mirrors asks who sees whom once") {
  const TemporaryFolder folder;
  // A ball above a mirror, a mirror beside it and a wall behind: what the mirrors bring back takes several rounds.
  const std::string scene = folder.write(
      "mirrors.toml", mirror_scene() +
                          "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -1.0, -1.0]\nedge_u = [0.0, 2.0, 0.0]\n"
                          "edge_v = [0.0, 0.0, 2.0]\nspacing = 0.1\nmaterial = \"mirror\"\n"
                          "[[shape]]\ntype = \"quad\"\ncorner = [-1.0, -1.0, -1.2]\nedge_u = [2.0, 0.0, 0.0]\n"
                          "edge_v = [0.0, 2.0, 0.0]\nspacing = 0.1\nmaterial = \"grey\"\n"
                          "[caustics]\nphotons = 20000\nfeedback = true\n");
  for (const char* method : {"fmm", "direct"}) {
    const auto stats = [&](const char* indirect) {
      const Run run = run_program("render " + scene + " --quiet --size 8x6 -o " + folder.file("x.exr") + " --stats " +
                                      folder.file("s.json") + " --set radiosity.method=" + method +
                                      " --set caustics.indirect=" + indirect,
                                  "POINTGI_CACHE_DIR=" + folder.file(std::string(method) + indirect));
      CAPTURE(run.err);
      REQUIRE(run.code == 0);
      return json_of(folder.file("s.json"));
    };
    const auto one = stats("false"), rounds = stats("true");
    CAPTURE(method);
    const auto exchanges = [&](const nlohmann::json& of) {
      const auto ran = names_of(of["stages"], true);
      return std::count(ran.begin(), ran.end(), method);
    };
    CHECK(exchanges(one) == 1);
    CHECK(exchanges(rounds) >= 3);
    CHECK(one["radiosity"]["rays"] > 1000);
    CHECK(rounds["radiosity"]["rays"] == one["radiosity"]["rays"]);
    CHECK(rounds["radiosity"]["iterations"] > one["radiosity"]["iterations"]);
  }
}

TEST_CASE("light between surfaces is part of a picture unless the scene or the command has no need of it") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const auto stats_of = [&](const std::string& input, const std::string& options) {
    const Run run = run_program("render " + input + " --quiet -o " + folder.file("x.exr") + " --stats " +
                                folder.file("s.json") + options);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    return json_of(folder.file("s.json"));
  };
  const auto whole = stats_of(scene, " --set radiosity.method=fmm");
  CHECK(names_of(whole["stages"], true) ==
        std::vector<std::string>{"scene", "cloud", "octree", "shafts", "vmap", "fmm", "render", "image"});
  CHECK(names_of(whole["stages"], false) == std::vector<std::string>{"normals", "photon"});
  for (const char* figure : {"pairs_tested", "links", "rays"})
    CHECK(whole["vmap"][figure].is_number());
  for (const char* figure : {"order", "m2l", "p2p", "iterations", "residual"})
    CHECK(whole["radiosity"][figure].is_number());
  CHECK(whole["radiosity"]["method"] == "fmm");
  CHECK(read_exr(folder.file("x.exr")).channels.count("Diffuse.G") == 1);
  struct Case {
    std::string options, reason;
  };
  const std::vector<Case> cases = {
      {" --set radiosity.method=none", "radiosity.method = \"none\": direct light only"},
      {" --set light.0.power_w=[0,0,0]", "the scene has no light and no emission"},
      {" --set material.0.albedo=[0,0,0]", "nothing in the scene is diffuse with an albedo above 0"},
      {" --integrator path", "the path tracer makes the picture"},
  };
  for (const Case& c : cases) {
    const auto stats = stats_of(scene, c.options);
    CAPTURE(c.options);
    for (const char* stage : {"vmap", "fmm"})
      CHECK(reason_of(stats["stages"], stage) == c.reason);
    CHECK(stats.count("vmap") == 0);
    CHECK(stats.count("radiosity") == 0);
    CHECK((read_exr(folder.file("x.exr")).channels.count("Diffuse.G") == 1) == (c.options == " --integrator path"));
  }
  const std::string cloud = folder.write("three.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                                      "property float y\nproperty float z\nend_header\n"
                                                      "0 0 0\n1 0 0\n0 1 0\n");
  CHECK(reason_of(stats_of(cloud, " --size 16x12 --set radiosity.method=fmm")["stages"], "fmm")
            .empty()); // a bare cloud, too
  // A ball alone sends itself nothing, which the planner knows before it asks who sees whom.
  const auto planned = stats_of(scene, "");
  CHECK(names_of(planned["stages"], true) ==
        std::vector<std::string>{"scene", "cloud", "octree", "shafts", "plan", "render", "image"});
  for (const char* stage : {"vmap", "fmm"})
    CHECK_THAT(reason_of(planned["stages"], stage), Contains("less than 0.001 of the light, radiosity.least_share"));
}
