/// What a device, a disk or a memory that fails does to a whole run of the program: some of the fault points that
/// scripts/faults tries all of, and devices that give less than others.
#include "tests/golden/faults/fault_sweep.h"
#include "tests/support/stats_file.h"
#include <catch2/catch.hpp>
#include <cerrno>
#include <set>

using namespace pointgi::test;
using Catch::Contains;

namespace {

/// Of each function among the faults the first one and one of the later ones; of allocations `places`.
std::vector<Fault> some_of(const std::string& kind, const CallReport& calls, std::size_t places = 6) {
  std::map<std::string, std::vector<Fault>> of_function;
  for (const Fault& fault : faults_of(kind, calls))
    of_function[fault.call].push_back(fault);
  std::vector<Fault> some;
  for (const auto& [name, all] : of_function) {
    const std::size_t wanted =
        name == "allocation" ? std::min(places, all.size()) : std::min<std::size_t>(2, all.size());
    for (std::size_t i = 0; i < wanted; ++i)
      some.push_back(all[i == 0 ? 0 : i * (all.size() - 1) * 2 / (2 * wanted - 1)]);
  }
  return some;
}

/// Tries some faults of these kinds. All of them were met, but `not_met`.
void check_kinds(const FaultScene& scene, const std::vector<std::string>& kinds, std::size_t places = 6) {
  for (const std::string& kind : kinds) {
    const FaultTally tally = try_faults(scene, some_of(kind, scene.calls(), places));
    CAPTURE(kind, tally.right_pictures, tally.clear_errors);
    for (const std::string& finding : tally.findings)
      FAIL_CHECK(finding);
    CHECK(tally.tried > 0);
    CHECK(tally.not_met == 0);
    CHECK(tally.clear_errors + tally.killed > 0);
  }
}

} // namespace

TEST_CASE("faults: an OpenCL call that fails ends in the right picture or in one clear error", "[faults][long]") {
  check_kinds(FaultScene(fmm_way()), {"device", "build", "buffer", "enqueue", "read", "event"});
  check_kinds(FaultScene(images_way()), {"image"});
}

TEST_CASE("faults: a program that the driver does not build is told with the driver's own code", "[faults][long]") {
  const FaultScene scene(directions_way());
  CallReport report;
  for (const char* lasts : {"", " FAULT_LASTS=1"}) { // with no log to be had, either
    const Run run =
        scene.run(std::string("FAULT_CALL=clBuildProgram FAULT_AT=2 FAULT_CODE=-11") + lasts, "", 0, report);
    CHECK(run.code == 4);
    for (const char* part : {"error: kernels/", "CL_BUILD_PROGRAM_FAILURE (-11)",
                             "\ndevice:", "\ndriver:", "\noptions:", "; use another --device"})
      CHECK_THAT(run.err, Contains(part));
  }
}

TEST_CASE("faults: a file that is not read or written leaves the old ones, and one clear error", "[faults][long]") {
  check_kinds(FaultScene(fmm_way()), {"file"});
}

TEST_CASE("faults: a run that is killed while it writes leaves old files or whole new ones", "[faults][long]") {
  check_kinds(FaultScene(fmm_way()), {"killed"});
}

TEST_CASE("faults: a run whose last file the disk does not take keeps its work and tells how to go on", "[faults]") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.toml", small_scene());
  // A file is written to the disk, then its folder: a picture has two before the last one, a cloud has one.
  const std::pair<std::string, int> commands[] = {{"render " + scene + " -o " + folder.file("x.exr"), 5},
                                                  {"bake " + scene + " -o " + folder.file("x.ply"), 3}};
  for (const auto& [begin, last] : commands) {
    const std::string command = begin + " --checkpoint-seconds 0 --stats " + folder.file("stats.json");
    const Run run = run_program(command, with_faults() + " FAULT_CALL=fsync FAULT_AT=" + std::to_string(last) +
                                             " FAULT_CODE=" + std::to_string(ENOSPC));
    CAPTURE(command, run.err);
    CHECK(run.code == 5);
    CHECK_THAT(run.err, Contains("stats.json: cannot write") && Contains("with --resume goes on from"));
    const Run resumed = run_program(command + " --resume");
    CAPTURE(resumed.err);
    CHECK(resumed.code == 0);
    CHECK_THAT(resumed.err, Contains("were an earlier run's"));
  }
}

TEST_CASE("faults: threads that are not to be had are done without", "[faults][long]") {
  const FaultScene scene(fmm_way());
  for (const bool all : {false, true}) {
    const Judgement judgement = scene.judge({"pthread_create", all ? "1" : "2", EAGAIN, all});
    CAPTURE(all, judgement.finding);
    CHECK(judgement.outcome == Outcome::right_picture);
  }
}

TEST_CASE("faults: memory that the host refuses ends in one clear error, once and from then on", "[faults][long]") {
  check_kinds(FaultScene(fmm_way()), {"allocation", "exhausted"}, 10);
}

TEST_CASE("faults: programs that the driver does not take from the cache are compiled again", "[faults][long]") {
  const FaultScene scene(cached_programs_way());
  REQUIRE(scene.calls().counts.count("clCreateProgramWithBinary") == 1);
  for (const char* call : {"clCreateProgramWithBinary", "clBuildProgram"}) {
    const Judgement judgement = scene.judge({call, "2", -42, false});
    CAPTURE(judgement.finding);
    CHECK(judgement.outcome == Outcome::right_picture);
  }
  for (const char* at : {"12", "13"}) { // of the cache
    const Judgement judgement = scene.judge({"read", at, EIO, false});
    CAPTURE(at, judgement.finding);
    CHECK(judgement.outcome == Outcome::right_picture);
  }
  CHECK(scene.undisturbed().empty());
}

TEST_CASE("faults: a device that is lost in the middle ends the run, and the old picture stays", "[faults]") {
  const FaultScene scene(directions_way());
  const std::size_t launches = scene.calls().counts.at("clEnqueueNDRangeKernel");
  for (const std::size_t n : {std::size_t{1}, launches / 2, launches})
    for (const char* call : {"clEnqueueNDRangeKernel", "clWaitForEvents"}) {
      const Judgement judgement = scene.judge({call, std::to_string(n), -9999, true});
      CAPTURE(call, n, judgement.finding);
      CHECK(judgement.outcome == Outcome::clear_error);
    }
  CallReport report;
  const Run lost = scene.run("FAULT_CALL=clWaitForEvents FAULT_AT=3 FAULT_CODE=-9999 FAULT_LASTS=1", "", 0, report);
  CHECK(lost.code == 4);
  CHECK_THAT(lost.err, Contains("was launched and did not end") && Contains("use another --device"));
  CHECK(scene.undisturbed().empty());
}

TEST_CASE("faults: a device that gives 128 MiB at most in one piece", "[faults]") {
  const std::string cap = "DEVICE_LARGEST_BUFFER=134217728 ", small_cap = "DEVICE_LARGEST_BUFFER=524288 ";
  CHECK(FaultScene(fmm_way()).undisturbed(cap).empty());
  // The same in small: what lies in one piece otherwise is split, and the picture is the same.
  FaultScene::Way many = directions_way();
  many.options += " --set radiosity.directions=1024";
  const FaultScene scene(many);
  REQUIRE(scene.calls().largest.at("clCreateBuffer") > 524288);
  CHECK(scene.undisturbed(small_cap).empty());
  // Splats that do not fit in one piece are refused before any work.
  CallReport report;
  const std::string three_million =
      "--set radiosity.method=none --set caustics.photons=0 --set shape.2.spacing=0.00115";
  const Run refused = scene.run(cap, three_million, 0, report);
  CHECK(refused.code == 6);
  CHECK_THAT(refused.err, Contains("at most in one piece") && Contains("134217728 bytes (128 MiB)") &&
                              Contains("use a smaller cloud"));
}

TEST_CASE("faults: a device without images makes the same picture of buffers", "[faults]") {
  const FaultScene scene(directions_way());
  CHECK(scene.undisturbed("DEVICE_NO_IMAGES=1").empty());
  // One that is asked for images all the same says what it lacks.
  CallReport report;
  const Run asked = scene.run("DEVICE_NO_IMAGES=1", "--set traversal.storage=image2d", 0, report);
  CHECK(asked.code == 2);
  CHECK_THAT(asked.err, Contains("images want a device with images") && Contains("leave them out"));
}

TEST_CASE("faults: launches stay short of a watchdog that ends those of over two seconds", "[faults][long]") {
  // A band of the picture, or all photons, would be a launch of over two seconds.
  const std::string slow = "DEVICE_ITEMS_PER_SECOND=10000 ";
  for (FaultScene::Way way : {fmm_way(), directions_way()}) {
    way.options += " --size 640x32 --set caustics.photons=30000";
    const FaultScene scene(way);
    REQUIRE(scene.undisturbed(slow).empty());
    std::map<std::string, int> launches;
    const auto trace = json_of(scene.output("trace.json"));
    for (const auto& event : trace["traceEvents"]) {
      if (event["ph"] != "X" || event["cat"] != "kernel") continue;
      const std::string kernel = event["name"];
      const double seconds = 1e-6 * event["dur"].get<double>();
      CAPTURE(way.name, kernel, seconds);
      constexpr int first_ones = 4; // until the pace is found
      CHECK(seconds < (++launches[kernel] > first_ones ? 0.2 : 2.0));
    }
    CHECK(launches["shade_pixels"] > 4);
    CHECK(launches["trace_photons"] > 4);
  }
  // So slow that the fewest work-items which keep the device busy take too long: the watchdog is there.
  const FaultScene scene(directions_way());
  CallReport report;
  const Run ended = scene.run("DEVICE_ITEMS_PER_SECOND=10", "", 0, report);
  CHECK(ended.code == 4);
  CHECK_THAT(ended.err, Contains("watchdog") && Contains("CL_OUT_OF_RESOURCES"));
}
