/// Runs that were killed go on with --resume, to the same bits.
#include "host/image/picture_writer.h"
#include "tests/support/killed_run.h"
#include "tests/support/run_program.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>
#include <chrono>
#include <random>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

/// Every stage: lamp and shafts, V-map and fmm, normals and photons, and light that goes round by the mirror.
std::string scene_of_all_stages() {
  return mirror_scene() +
         "[[shape]]\ntype = \"quad\"\ncorner = [-1.5, -1.1, -1.5]\nedge_u = [3.0, 0.0, 0.0]\nedge_v = [0.0, 3.0, 0.0]\n"
         "spacing = 0.1\nmaterial = \"grey\"\n"
         "[radiosity]\nmethod = \"fmm\"\n[caustics]\nphotons = 20000\nindirect = true\nfeedback = true\n";
}

/// A command that writes `file` below a folder of its own, and keeps all that it has finished.
struct Work {
  TemporaryFolder folder;
  std::string file, command;

  Work(const std::string& kind, const std::string& text, const std::string& options, const std::string& name = "x.exr")
      : file(folder.file(name)), command(kind + " " + folder.write("scene.toml", text) + " --checkpoint-seconds 0 -o " +
                                         file + (options.empty() ? "" : " " + options)) {}

  std::string checkpoint() const { return file + ".checkpoint"; }
  std::size_t kept() const { return files_that_end(checkpoint(), ".kept"); }
  bool kill_after(std::size_t pieces) const {
    return run_and_kill(command, folder.file("log"), [&] { return kept() >= pieces; });
  }
  /// Bytes of the file, less what a picture says of its making.
  std::map<std::string, std::vector<float>> picture() const { return read_exr(file).channels; }
};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// Neither the checkpoint nor half of a file is left.
void check_tidy(const Work& work) {
  CHECK_FALSE(std::filesystem::exists(work.checkpoint()));
  CHECK(files_that_end(work.folder.file(""), ".tmp") == 0);
}

} // namespace

TEST_CASE("a render that was killed after any piece of work goes on to the same bits", "[resume][long]") {
  for (const char* options : {"", "--progressive --spp 96"}) {
    const Work work("render", scene_of_all_stages(), options);
    const std::string stats = work.folder.file("stats.json");
    REQUIRE(run_program(work.command + " --stats " + stats).code == 0);
    const auto undisturbed = work.picture();
    const nlohmann::json said = json_of(stats);
    for (const char* section : {"radiosity", "vmap", "photons"})
      REQUIRE(said.contains(section));
    check_tidy(work);
    bool used = false;
    for (const std::size_t pieces : {1, 2, 3, 4, 6}) {
      CAPTURE(options, pieces);
      std::filesystem::remove(work.file);
      std::filesystem::remove(stats);
      const bool killed = work.kill_after(pieces);
      const Run resumed = run_program(work.command + " --resume --stats " + stats);
      INFO(resumed.err);
      REQUIRE(resumed.code == 0);
      CHECK(work.picture() == undisturbed);
      const nlohmann::json again = json_of(stats);
      for (const char* section : {"radiosity", "vmap", "photons"})
        CHECK(again[section] == said[section]);
      check_tidy(work);
      used = used || (killed && resumed.err.find("an earlier run has kept its light") != std::string::npos);
    }
    CHECK(used); // or nothing was resumed
  }
}

TEST_CASE("a bake and a path-traced picture that were killed go on to the same bits", "[resume]") {
  const Work bake("bake", scene_of_all_stages(), "", "lit.ply");
  REQUIRE(run_program(bake.command).code == 0);
  const std::string undisturbed = bytes_of(bake.file);
  std::filesystem::remove(bake.file);
  bake.kill_after(2);
  REQUIRE(run_program(bake.command + " --resume").code == 0);
  CHECK(bytes_of(bake.file) == undisturbed);
  check_tidy(bake);
  const Work paths("render", scene_of_all_stages(), "--integrator path --spp 40");
  REQUIRE(run_program(paths.command).code == 0);
  const auto picture = paths.picture();
  CHECK(paths.kill_after(1));
  REQUIRE(run_program(paths.command + " --resume").code == 0);
  CHECK(paths.picture() == picture);
  check_tidy(paths);
}

TEST_CASE("an interrupted render tells how to go on, and --resume does", "[resume][long]") {
  const Work work("render", small_scene(), "--spp 64");           // its size is given below
  REQUIRE(run_program(work.command + " --size 40x30").code == 0); // builds the kernels
  const std::string slow = work.command + " --size 600x2000";
  const Run run = run_program(slow, "timeout --foreground --preserve-status -s INT 2");
  if (run.code == 0) return; // on a very fast machine
  CHECK(run.code == 130);
  if (work.kept() == 0) return; // it came before any work was done
  CHECK_THAT(run.err, Contains("the same command with --resume goes on from " + work.checkpoint()));
  const Run anew = run_program("render " + work.folder.file("scene.toml") + " -o " + work.file);
  CHECK_THAT(anew.err, Contains("an earlier run has kept work here, which --resume goes on from"));
  CHECK(work.kept() > 0); // short work does not take the place of what is kept
  const Run resumed = run_program(slow + " --resume");
  REQUIRE(resumed.code == 0);
  CHECK_THAT(resumed.err, Contains("pieces of work were an earlier run's"));
  check_tidy(work);
}

TEST_CASE("what is damaged, of another scene, or cannot be kept is told, and the picture is right", "[resume]") {
  const Work work("render", scene_of_all_stages(), "");
  REQUIRE(run_program(work.command).code == 0);
  const auto undisturbed = work.picture();
  REQUIRE(work.kill_after(3));
  std::mt19937 g(1);
  std::size_t damaged = 0;
  for (const auto& entry : std::filesystem::directory_iterator(work.checkpoint())) {
    std::string bytes = bytes_of(entry.path().string());
    if (bytes.empty()) continue;
    bytes[g() % bytes.size()] ^= 1;
    if (++damaged % 2 == 0) bytes.resize(bytes.size() / 2);
    std::ofstream(entry.path(), std::ios::binary) << bytes;
  }
  const Run resumed = run_program(work.command + " --resume");
  CHECK(resumed.code == 0);
  CHECK_THAT(resumed.err, Contains("it is not used, and what it should hold is computed again"));
  CHECK(work.picture() == undisturbed);
  check_tidy(work);

  REQUIRE(work.kill_after(2));
  const Run other = run_program(work.command + " --resume --set light.0.power_w=[80,90,90]");
  CHECK(other.code == 0);
  CHECK_THAT(other.err, Contains("is of another scene, other settings, or another device"));
  CHECK(work.picture() != undisturbed);
  check_tidy(work);

  // Twice the power is the same light in other units, and another picture.
  for (const char* power : {"[180,180,180]", "[45,45,45]"}) {
    const std::string changed = std::string(" --set light.0.power_w=") + power;
    REQUIRE(run_program(work.command + changed).code == 0);
    const auto right = work.picture();
    work.kill_after(5);
    REQUIRE(run_program(work.command + " --resume" + changed).code == 0);
    CHECK(work.picture() == right);
  }

  // What another run has kept stays where this one keeps nothing.
  REQUIRE(work.kill_after(2));
  const Run short_run =
      run_program("render " + work.folder.write("other.toml", small_scene()) + " --resume -o " + work.file);
  CHECK(short_run.code == 0);
  CHECK(work.kept() >= 2);
  REQUIRE(run_program(work.command + " --resume").code == 0);
  CHECK(work.picture() == undisturbed);

  work.folder.write("x.exr.checkpoint", "a file stands where the folder should");
  const Run without = run_program(work.command);
  CHECK(without.code == 0);
  CHECK_THAT(without.err, Contains("The run goes on without keeping what it has done"));
  CHECK(without.err.find("warning") == without.err.rfind("warning")); // once
  CHECK(work.picture() == undisturbed);
}

TEST_CASE("work that is done soon is not kept, and resuming goes with no goal that time decides", "[resume]") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ball.toml", small_scene()), out = folder.file("x.exr");
  CHECK_FALSE(run_and_kill("render " + scene + " -o " + out, folder.file("log"),
                           [&] { return std::filesystem::exists(out + ".checkpoint"); }));
  const Run nothing = run_program("render " + scene + " -o " + out + " --resume");
  CHECK(nothing.code == 0);
  CHECK_THAT(nothing.err, Contains("--resume: nothing is kept in " + out + ".checkpoint"));
  const Run timed = run_program("render " + scene + " -o " + out + " --resume --time 5");
  CHECK(timed.code == 2);
  CHECK_THAT(timed.err, Contains("error: --resume: what is to be done follows from --time"));
}

TEST_CASE("a render that was killed at 50 random moments goes on to the same bits", "[resume][long]") {
  for (const char* options : {"", "--progressive --spp 96"}) {
    const Work work("render", scene_of_all_stages(), options);
    REQUIRE(run_program(work.command).code == 0); // builds the kernels
    const auto begun = std::chrono::steady_clock::now();
    const auto now = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(); };
    REQUIRE(run_program(work.command).code == 0);
    const double whole = now();
    const auto undisturbed = work.picture();
    std::mt19937 g(18);
    for (int kill = 0; kill < 25; ++kill) {
      CAPTURE(options, kill);
      const double moment = now() + whole * static_cast<double>(g()) / 4294967296.0;
      run_and_kill(work.command + " --resume", work.folder.file("log"), [&] { return now() >= moment; });
      const Run resumed = run_program(work.command + " --resume");
      INFO(resumed.err);
      REQUIRE(resumed.code == 0);
      REQUIRE(work.picture() == undisturbed);
      check_tidy(work);
    }
  }
}
