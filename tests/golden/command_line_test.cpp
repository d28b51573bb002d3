/// What the command line promises: exit codes, messages, files (interface.md).
#include "host/image/picture_writer.h"
#include "tests/support/hdr_bytes.h"
#include "tests/support/run_program.h"
#include "tests/support/scans.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <random>
#include <set>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// The ball by direct light alone: what its picture needs is then a list that one can write down.
std::string direct_scene() {
  return std::string(small_scene()) + "[radiosity]\nmethod = \"none\"\n";
}

} // namespace

TEST_CASE("render writes picture, stats and trace, and names the picture on stdout") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", direct_scene()), out = folder.file("ball.exr");
  const Run run = run_program("render " + scene + " -o " + out + " --stats " + folder.file("s.json") + " --trace " +
                              folder.file("t.json"));
  REQUIRE(run.code == 0);
  CHECK(run.out == out + "\n" + folder.file("ball.png") + "\n");
  const Picture picture = read_exr(out);
  CHECK(picture.width == 40);
  for (const char* channel : {"R", "G", "B", "A", "Direct.R", "Albedo.G", "N.X", "P.Z", "Z", "PointId"})
    CHECK(picture.channels.count(channel) == 1);
  CHECK(picture.attributes.number.at("samplesPerPixel") == 4.0);
  CHECK(picture.attributes.number.count("renderTimeSeconds") == 1);
  for (const char* name : {"software", "pointgi/device", "pointgi/scene_hash", "pointgi/quality"})
    CHECK(picture.attributes.text.count(name) == 1);
  const auto stats = json_of(folder.file("s.json"));
  CHECK(stats["scene"]["points"] > 1000);
  CHECK(stats["render"]["eye_rays"] == 40 * 30 * 4);
  const auto ran = names_of(stats["stages"], true);
  CHECK(ran == std::vector<std::string>{"scene", "cloud", "octree", "shafts", "render", "image"});
  CHECK(names_of(stats["stages"], false) == std::vector<std::string>{"vmap", "fmm", "normals", "photon"});
  std::size_t stages = 0, launches = 0;
  double stages_end = 0.0;
  const auto trace = json_of(folder.file("t.json"));
  for (const auto& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    stages += event["cat"] == "stage";
    if (event["cat"] == "stage") stages_end = event["ts"].get<double>() + event["dur"].get<double>();
    if (event["cat"] != "kernel") continue;
    launches += 1;
    CHECK((event["name"] == "trace_eye_rays" || event["name"] == "shade_pixels" ||
           event["name"] == "direct_irradiance_of_points"));
  }
  CHECK(stages == ran.size());
  CHECK(launches == stats["kernels"]["trace_eye_rays"]["launches"].get<std::size_t>() +
                        stats["kernels"]["shade_pixels"]["launches"].get<std::size_t>() +
                        stats["kernels"]["direct_irradiance_of_points"]["launches"].get<std::size_t>());
  CHECK(stats["render"]["eye_mrays_per_s"] > 0.0);
  for (const auto& event : trace["traceEvents"]) // within the run, on its own clock
    if (event["ph"] == "X") CHECK((event["ts"] >= 0.0 && event["ts"] <= stages_end));
  CHECK_THAT(stats["variant"]["source"].get<std::string>(), Contains("default of"));
  CHECK_THAT(run.err, Contains("variant: " + stats["variant"]["name"].get<std::string>()));
}

TEST_CASE("the scene's hash is another where light is computed another way", "[long]") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.toml", small_scene());
  std::set<std::string> hashes;
  const auto hash_with = [&](const std::string& more) {
    const std::string out = folder.file("x.exr");
    const Run run = run_program("render " + scene + " --quiet --size 8x8 --spp 1 -o " + out + " " + more);
    CAPTURE(more, run.err);
    REQUIRE(run.code == 0);
    return read_exr(out).attributes.text.at("pointgi/scene_hash");
  };
  const std::string plain = hash_with("");
  CHECK(hash_with("") == plain);
  for (const char* more :
       {"--set radiosity.method=none", "--set radiosity.order=2", "--set radiosity.epsilon=0.01",
        "--set caustics.gather_k=20", "--integrator path", "--integrator path --paths LDE", "--quality draft"}) {
    const std::string hash = hash_with(more);
    CAPTURE(more);
    CHECK(hash != plain);
    CHECK(hashes.insert(hash).second);
  }
}

TEST_CASE("a mirror adds the stages normals and photon, and the channels of their light", "[long]") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("mirror.toml", mirror_scene());
  const auto stats_of = [&](const std::string& options) {
    const Run run = run_program("render " + scene + " --quiet -o " + folder.file("x.exr") + " --stats " +
                                folder.file("s.json") + options);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    return json_of(folder.file("s.json"));
  };
  const auto whole = stats_of(" --set caustics.photons=2000");
  CHECK(names_of(whole["stages"], true) ==
        std::vector<std::string>{"scene", "cloud", "octree", "shafts", "plan", "vmap", "fmm", "normals", "photon",
                                 "photon", "render", "image"}); // sent, then what they bring to points
  CHECK(whole["photons"]["stored"] > 0);
  CHECK(whole["photons"]["kept"] == whole["photons"]["stored"]);
  for (const char* channel : {"Diffuse.G", "Specular.G", "Caustic.G"})
    CHECK(read_exr(folder.file("x.exr")).channels.count(channel) == 1);
  CHECK(reason_of(stats_of(" --set caustics.photons=0")["stages"], "photon") == "caustics.photons = 0");
  CHECK(reason_of(stats_of(" --integrator path")["stages"], "photon") == "the path tracer makes the picture");
}

TEST_CASE("wrong usage is exit code 2 and says what is right") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  struct Case {
    std::string arguments, says;
  };
  const std::vector<Case> cases = {
      {"", "subcommand"},
      {"paint", "paint"},
      {"render", "required"},
      {"render " + scene + " --size 10", "--size: expected WIDTHxHEIGHT"},
      {"render " + scene + " --size 10x", "--size: expected WIDTHxHEIGHT"},
      {"render " + scene + " --size 0x10", "1 to 65536 pixels each"},
      {"render " + scene + " --spp 0", "--spp"},
      {"render " + scene + " --qualty draft", "did you mean \"--quality\""},
      {"render " + scene + " --pixelbounds 0,50,0,10", "0 <= x0 < x1 <= 40"},
      {"render " + scene + " --pixelbounds 5,5,0,10", "x0 < x1"},
      {"render " + scene + " --quality best", "draft"},
      {"render " + scene + " --integrator radiance", "radiance"},
      {"render " + scene + " --threads 0", "--threads"},
      {"render " + scene + " --set render.spp", "render.spp"},
  };
  for (const Case& c : cases) {
    const Run run = run_program(c.arguments);
    CAPTURE(c.arguments, run.err);
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains(c.says));
  }
}

TEST_CASE("the environment's map is an input, which no output replaces") {
  const TemporaryFolder folder;
  const std::string map = folder.write("sky.hdr", hdr_header(1, 1) + hdr_row({{9, 9, 9, 128}}, HdrCode::flat));
  const std::string scene =
      folder.write("ball.toml", std::string(small_scene()) + "[environment]\nmap = \"sky.hdr\"\n");
  const Run run = run_program("render " + scene + " -o " + folder.file("x.exr") + " --stats " + map);
  CAPTURE(run.err);
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("sky.hdr is an input"));
}

TEST_CASE("the name that a picture gets by default is no input's, either") {
  const TemporaryFolder folder;
  folder.write("scan.png", "an input, whatever it holds");
  const Run run = run_program("render scan.png", "cd " + folder.file("") + " &&");
  CAPTURE(run.err);
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("scan.png would be written, but is an input") && Contains("name another with -o"));
}

TEST_CASE("wrong input is exit code 3 and names the file") {
  const TemporaryFolder folder;
  struct Case {
    std::string arguments, says;
  };
  const std::vector<Case> cases = {
      {"render " + folder.file("none.toml"), "none.toml"},
      {"render " + folder.file("none.ply"), "none.ply"},
      {"render " + folder.write("empty.ply", ""), "empty.ply"},
      {"render " + folder.write("text.xyz", "1 2\n"), "text.xyz"},
      {"render " + folder.write("scan.las", "LASF"), "truncated"},
      {"render " + folder.write("b.toml", small_scene()) + " --set render.sp=3", "did you mean \"spp\""},
  };
  for (const Case& c : cases) {
    const Run run = run_program(c.arguments + " -o " + folder.file("out.exr"));
    CAPTURE(c.arguments, run.err);
    CHECK(run.code == 3);
    CHECK_THAT(run.err, Contains(c.says));
  }
  CHECK(run_program("info " + folder.file("none.ply")).code == 3);
}

TEST_CASE("unknown devices and unwritable places have exit codes of their own") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  const Run device = run_program("render " + scene + " --device quantum -o " + folder.file("x.exr"));
  CHECK(device.code == 4);
  CHECK_THAT(device.err, Contains("quantum") && Contains("0  "));
  const Run environment = run_program("render " + scene + " -o " + folder.file("x.exr"), "POINTGI_DEVICE=quantum");
  CHECK(environment.code == 4);
  const Run flag_wins =
      run_program("render " + scene + " --device 0 -o " + folder.file("x.exr"), "POINTGI_DEVICE=quantum");
  CHECK(flag_wins.code == 0);
  CHECK(run_program("render " + scene + " -o " + folder.file("missing/x.exr")).code == 5);
  CHECK(run_program("render " + scene + " -o " + folder.file("x.jpg")).code == 5);
  CHECK(run_program("render " + scene + " -o " + folder.file("y.exr") + " --stats /dev/full").code == 5);
}

TEST_CASE("a second start builds no kernel, and a damaged cache is built anew", "[long]") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", direct_scene());
  for (const char* cache : {"ours", "poc"})
    std::filesystem::create_directory(folder.file(cache));
  const std::string caches = "POINTGI_CACHE_DIR=" + folder.file("ours") + " POCL_CACHE_DIR=" + folder.file("poc");
  const std::string arguments = "render " + scene + " -o " + folder.file("x.exr") + " --stats " + folder.file("s.json");
  /// Each start's programs, and the compiled kernels on disk with the time at which each was written.
  const auto start = [&] {
    REQUIRE(run_program(arguments, caches).code == 0);
    std::map<std::string, std::filesystem::file_time_type> kernels;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.file("poc")))
      if (entry.path().extension() == ".so") kernels[entry.path().string()] = entry.last_write_time();
    return std::pair{json_of(folder.file("s.json"))["programs"], kernels};
  };
  const auto [first, compiled] = start();
  const auto [second, kept] = start();
  CHECK(second["compiled"] == 0);
  if (first["kept_by_driver"] == 0) {
    CHECK(first["compiled"] == 3); // of the shafts' rays, the eye's and the picture
    CHECK(second["from_cache"] == 3);
  } else { // PoCL, which writes each kernel that it compiles
    CHECK(first["kept_by_driver"] == 3);
    CHECK(compiled.size() >= 3);
    CHECK(kept == compiled);
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.file("ours")))
    if (entry.is_regular_file())
      std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 3);
  REQUIRE(run_program(arguments, caches).code == 0);
}

TEST_CASE("the same bits on 1, 2 and 4 threads") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  std::vector<float> first;
  for (const char* threads : {"1", "2", "4"}) {
    REQUIRE(run_program("render " + scene + " --threads " + threads + " -o " + folder.file("x.exr")).code == 0);
    const auto values = read_exr(folder.file("x.exr")).channels.at("R");
    if (first.empty()) first = values;
    CHECK(values == first);
  }
}

TEST_CASE("an interrupted render keeps a partial picture, and a killed one keeps the old picture", "[long]") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = folder.file("x.exr");
  const std::string slow = "render " + scene + " --size 600x2000 --spp 128 -o " + out;
  REQUIRE(run_program("render " + scene + " -o " + out).code == 0);
  // --foreground: the program gets the signal once; a second one would end it at once.
  // Whenever the signal comes, the old picture or a whole partial one is there.
  const Run killed = run_program(slow, "timeout -s KILL 2");
  CHECK(killed.code != 0);
  CHECK(read_exr(out).width == 40);
  const Run interrupted = run_program(slow, "timeout --foreground --preserve-status -s INT 4");
  CHECK(interrupted.code == 130);
  CHECK_THAT(interrupted.err, Contains("interrupted"));
  const Picture partial = read_exr(out);
  CHECK(partial.width == 600);
  CHECK(partial.height == 2000);
}

TEST_CASE("an interrupt between the launches of the device ends the program with a word") {
  const TemporaryFolder folder;
  std::mt19937 g(1);
  std::uniform_real_distribution<float> coordinate(-1.0f, 1.0f);
  std::string points(3 * sizeof(float) * 400'000, '\0'); // no surface: seconds of work to find normals, on any machine
  for (std::size_t i = 0; i < points.size(); i += sizeof(float)) {
    const float value = coordinate(g);
    std::memcpy(&points[i], &value, sizeof value);
  }
  const std::string cloud = folder.write("noise.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 400000\n"
                                                      "property float x\nproperty float y\nproperty float z\n"
                                                      "end_header\n" +
                                                          points);
  // Whenever the signal comes, there is a word for the stage that it ends. --foreground: it comes once.
  const Run run = run_program("render " + cloud + " --size 2000x2000 -o " + folder.file("x.exr"),
                              "timeout --foreground --preserve-status -s INT 0.5");
  CHECK(run.code == 130);
  CHECK_THAT(run.err, Contains("error: interrupted in the stage ") && Contains("; nothing was written"));
  CHECK_FALSE(std::filesystem::exists(folder.file("x.exr")));
}

TEST_CASE("kernels can be edited, and their errors name our files") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene());
  std::filesystem::copy(POINTGI_SOURCE_DIR "/kernels", folder.file("kernels"),
                        std::filesystem::copy_options::recursive);
  const std::string use = "POINTGI_KERNEL_DIR=" + folder.file("kernels") + " POINTGI_CACHE_DIR=" + folder.file("cache");
  const std::string arguments = "render " + scene + " -o " + folder.file("x.exr");
  CHECK(run_program(arguments, use).code == 0);
  std::ofstream(folder.file("kernels/surface/blend.cl"), std::ios::app)
      << "\nfloat broken(void) { return nonsense; }\n";
  const Run run = run_program(arguments, use);
  CHECK(run.code == 4);
  CHECK_THAT(run.err, Contains("kernels/surface/blend.cl:") && Contains("nonsense") && Contains("options:"));
  std::filesystem::remove(folder.file("kernels/surface/blend.cl"));
  CHECK(run_program(arguments, use).code == 2);
}

TEST_CASE("dumped kernels hold what the scene needs and no more") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", direct_scene());
  REQUIRE(
      run_program("render " + scene + " -o " + folder.file("x.exr") + " --dump-kernels " + folder.file("dump")).code ==
      0);
  std::string shade;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("dump")))
    if (entry.path().filename().string().rfind("render_shade-", 0) == 0) shade = entry.path().string();
  std::ifstream file(shade);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string options = text.substr(0, text.find('\n'));
  CHECK_THAT(options, Contains("HAS_LIGHT_SOURCES") && !Contains("HAS_EMITTERS") && !Contains("HAS_ENVIRONMENT") &&
                          !Contains("HAS_RADIOSITY"));
  CHECK_THAT(text, Contains("#line 1 \"kernels/surface/disc.cl\""));
}

TEST_CASE("info tells what a file holds, and devices list and check", "[long]") {
  const TemporaryFolder folder;
  const std::string cloud = folder.write("three.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                                      "property float y\nproperty float z\nproperty uchar weird\n"
                                                      "end_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n");
  const Run info = run_program("info " + cloud);
  CHECK(info.code == 0);
  CHECK_THAT(info.out, Contains("3 in the file") && Contains("weird") && Contains("not used") && Contains("estimated"));
  const Run scene = run_program("info " + folder.write("mirror.toml", mirror_scene()));
  CHECK(scene.code == 0);
  // The centres of its splats: half a spacing, 0.1, from the edges.
  CHECK_THAT(scene.out, Contains("shape.0 (sphere, ") && Contains("shape.1 (quad, ") &&
                            Contains("[-0.95, -1, -0.95] to [0.95, -1, 0.95]"));
  const Run devices = run_program("devices --json");
  CHECK(devices.code == 0);
  CHECK(nlohmann::json::parse(devices.out).size() >= 1);
  const Run named = run_program("devices --json", "POINTGI_DEVICE=quantum");
  CHECK(named.code == 4);
  CHECK_THAT(named.err, Contains("quantum"));
  CHECK(run_program("devices --json --device 0", "POINTGI_DEVICE=quantum").code == 0);
}

TEST_CASE("every sample file of other projects ends with 0 or 3 and a place in its message", "[long]") {
  const auto folder = scan_path("parser");
  if (!folder) {
    WARN("the parser samples are not there: skipped");
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    const Run run = run_program("info '" + entry.path().string() + "'", "ulimit -v 4000000; timeout 60");
    CAPTURE(entry.path().filename().string(), run.err);
    CHECK((run.code == 0 || run.code == 3));
    if (run.code == 3) CHECK_THAT(run.err, Contains("line ") || Contains("byte "));
  }
}

TEST_CASE("compare: figures on stdout as text or JSON, and exit codes") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), a = folder.file("a.exr"),
                    b = folder.file("b.exr"), part = folder.file("part.exr");
  REQUIRE(run_program("render " + scene + " --quiet --seed 1 -o " + a).code == 0);
  REQUIRE(run_program("render " + scene + " --quiet --integrator path --seed 2 -o " + b).code == 0);
  REQUIRE(run_program("render " + scene + " --quiet --pixelbounds 10,30,5,20 -o " + part).code == 0);
  Run run = run_program("compare " + b + " " + a + " --json");
  REQUIRE(run.code == 0);
  const auto found = nlohmann::json::parse(run.out);
  CHECK(found["pixels"] == 40 * 30);
  CHECK(found["all"]["mse"] > 0.0);
  for (const char* colour : {"R", "G", "B", "all"})
    for (const char* figure : {"mean_a", "mean_b", "mse", "rel_mse", "bias", "p99", "ssim"})
      CHECK(found[colour][figure].is_number());
  run = run_program("compare " + a + " " + part);
  CHECK(run.code == 0);
  CHECK_THAT(run.out, Contains("300 pixels, x from 10 to 30, y from 5 to 20") && Contains("+0.0000%"));
  run = run_program("compare " + a + " " + folder.file("none.exr"));
  CHECK(run.code == 3);
  CHECK_THAT(run.err, Contains("none.exr: no such file"));
  CHECK(run_program("compare " + a).code == 2);
  CHECK(run_program("compare " + a + " " + scene).code == 3);
}

TEST_CASE("a black picture says why, and what to change", "[long]") {
  const TemporaryFolder folder;
  const std::string head = "version = 1\n[render]\nsize = [16, 12]\nspp = 2\n"
                           "[camera]\nposition = [0, 1, 3]\nlook_at = [0, 0, 0]\n"
                           "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n"
                           "[[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nalbedo = [0, 0, 0]\n"
                           "emission = [4, 4, 4]\n";
  const auto quad = [](double height, const std::string& material, bool up) {
    const std::string z = "[0, 0, 4]\n", x = "[4, 0, 0]\n";
    return "[[shape]]\ntype = \"quad\"\ncorner = [-2, " + std::to_string(height) + ", -2]\nedge_u = " + (up ? z : x) +
           "edge_v = " + (up ? x : z) + "spacing = 0.1\nmaterial = \"" + material + "\"\n";
  };
  const auto warnings = [&](const std::string& scene, const std::string& options) {
    const Run run =
        run_program("render " + folder.write("s.toml", scene) + " --quiet -o " + folder.file("x.exr") + options);
    CHECK(run.code == 0);
    return run.err;
  };
  const std::string floor = head + quad(0.0, "grey", true), none = " --set radiosity.method=none",
                    path = " --integrator path",
                    light = "[[light]]\ntype = \"point\"\nposition = [0, 2, 0]\n"
                            "power_w = [9, 9, 9]\n";
  CHECK(warnings(floor + quad(1.5, "lamp", false), "").empty());
  for (const std::string& options : {std::string(), none, path}) {
    CAPTURE(options);
    const std::string found = warnings(floor + quad(1.5, "lamp", true), options);
    CHECK_THAT(found, Contains(options.empty() ? "no light reaches any surface" : "the picture is all black") &&
                          Contains("shape.1 (quad, ") && Contains("swap edge_u and edge_v"));
    CHECK(std::count(found.begin(), found.end(), '\n') == 1);
  }
  CHECK_THAT(warnings(floor + light, " --set light.0.position=[0,-2,0]" + none), Contains("[0, -2, 0] may lie inside"));
  CHECK_THAT(warnings(floor + light, " --set render.max_depth=0" + path), Contains("render.max_depth = 0 leaves out"));
  CHECK_THAT(warnings(floor + light, " --set material.0.albedo=[0,0,0]"), Contains("an albedo above 0"));
  const std::string backs = warnings(head + quad(0.0, "grey", false) + light, "");
  CHECK_THAT(backs, Contains("100 % of the eye rays") && Contains("shape.0 (quad, ") &&
                        Contains("swap edge_u and edge_v") && !Contains("[[cloud]]"));
  CHECK_THAT(warnings(floor + quad(0.5, "grey", false) + light, ""), Contains("most are of shape.1 (quad, "));
  const std::string caustics = warnings(floor + light, path + " --paths LS+DE");
  CHECK_THAT(caustics, Contains("no surface of it is specular"));
  CHECK(std::count(caustics.begin(), caustics.end(), '\n') == 1);
}

TEST_CASE("light paths go with the path tracer only") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = " --quiet -o " + folder.file("a.exr");
  Run run = run_program("render " + scene + out + " --paths LDE");
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("--integrator path"));
  run = run_program("render " + scene + out + " --integrator path --paths LXE");
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("expected D or S"));
  CHECK(run_program("render " + scene + out + " --integrator radiance").code == 2);
  REQUIRE(run_program("render " + scene + out + " --integrator path --paths LD+E").code == 0);
  const Picture picture = read_exr(folder.file("a.exr"));
  CHECK(picture.attributes.text.at("pointgi/integrator") == "path");
  CHECK(picture.attributes.text.at("pointgi/paths") == "LD+E");
  for (const char* channel : {"Variance.R", "Diffuse.B", "Direct.G"})
    CHECK(picture.channels.count(channel) == 1);
}

TEST_CASE("a PNG that is burnt or nearly black names the exposure, and the lamp that is too weak", "[long]") {
  const TemporaryFolder folder;
  const auto render = [&](const std::string& scene, const std::string& more) {
    return run_program("render " + folder.write("scene.toml", scene) + " -o " + folder.file("x.exr") + more);
  };
  const std::string lit = std::string(small_scene()) + "[environment]\nradiance = [1.0, 1.0, 1.0]\n";
  CHECK_THAT(render(lit, "").err, !Contains("warning"));
  const Run burnt = render(lit, " --exposure 9");
  CHECK_THAT(burnt.err, Contains("burnt to white at an exposure of 9") && Contains("--exposure auto"));
  CHECK_THAT(render(lit, " --exposure auto").err, Contains("exposure chosen: ") && !Contains("warning"));
  // 120 W in a scene of 5000 units.
  const std::string vast =
      "version = 1\n[render]\nsize = [40, 30]\nspp = 4\n"
      "[camera]\nposition = [0.0, 3000.0, 5000.0]\nlook_at = [0.0, 0.0, 0.0]\nfov_deg = 40.0\n"
      "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\nalbedo = [0.6, 0.6, 0.6]\n"
      "[[shape]]\ntype = \"disc\"\ncentre = [0.0, 0.0, 0.0]\nnormal = [0.0, 1.0, 0.0]\n"
      "radius = 2500.0\nspacing = 100.0\nmaterial = \"grey\"\n"
      "[[light]]\ntype = \"point\"\nposition = [0.0, 1500.0, 0.0]\npower_w = [120.0, 120.0, 120.0]\n";
  const Run dark = render(vast, "");
  CHECK(dark.code == 0);
  CHECK_THAT(dark.err, Contains("nearly black") && Contains("--exposure auto") &&
                           Contains("the point light at [0, 1500, 0]") && Contains("which is 5") &&
                           Contains("times as large"));
  CHECK_THAT(render(vast, " --exposure auto").err, !Contains("nearly black"));
}

TEST_CASE("options of the view are refused by their own names, and win") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", direct_scene()), to = " -o " + folder.file("x.exr");
  for (const char* wrong : {"bright", "1e9", "nan"}) {
    const Run run = run_program("render " + scene + to + " --exposure '" + wrong + "'");
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains("--exposure") && !Contains("--set"));
  }
  CHECK(run_program("render " + scene + to + " --up w").code == 2);
  CHECK(run_program("render " + scene + to + " --ground sea").code == 2);
  CHECK(run_program("render " + scene + to + " --up -z --exposure -1.5 --ground none").code == 0);
  const Run grounded = run_program("render " + scene + to + " --ground auto --stats " + folder.file("s.json"));
  CHECK(grounded.code == 0);
  const auto points = json_of(folder.file("s.json"))["scene"]["points"].get<std::size_t>();
  CHECK(run_program("render " + scene + to + " --stats " + folder.file("s.json")).code == 0);
  CHECK(points > 1000 + json_of(folder.file("s.json"))["scene"]["points"].get<std::size_t>());
}
