/// `pointgi measure` as a user starts it. No test looks at a time.
#include "host/error.h"
#include "host/measure/kept_errors.h"
#include "host/measure/measure.h"
#include "tests/support/run_program.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

struct Measuring {
  TemporaryFolder folder;
  std::string scene = folder.write("ball.toml", small_scene());
  std::string out = folder.file("out");

  Run measure(const std::string& more, const std::string& before = "") const {
    return run_program("measure " + scene + " -o " + out + " " + more, before);
  }
};

const MeasuredRun* named(const Trade& trade, const std::string& name) {
  for (const MeasuredRun& run : trade.runs)
    if (run.name == name) return &run;
  return nullptr;
}

} // namespace

TEST_CASE("measure finds a front, keeps it, and goes on with it", "[long]") {
  const Measuring setting;
  const std::string command = "--knobs render.spp,radiosity.directions --size 32x32 --budget 10 --target 1";
  const Run run = setting.measure(command);
  INFO(run.err);
  REQUIRE(run.code == 0);
  CHECK_THAT(run.out, Contains("95 % interval") && Contains("own") && Contains("pointgi render " + setting.scene));
  const Trade trade = read_trade(setting.out + "/trade.json");
  CHECK(trade.width == 32);
  CHECK_FALSE(trade.runs.empty());
  std::size_t front = 0;
  for (const MeasuredRun& one : trade.runs) {
    INFO(one.name);
    front += one.on_front ? 1 : 0;
    if (!one.refused.empty()) continue;
    CHECK(std::filesystem::exists(setting.out + "/" + one.picture));
    CHECK(one.error.low <= one.error.value);
    CHECK(one.error.value <= one.error.high);
    CHECK(one.stages.count("render") == 1);
  }
  CHECK(front > 0);
  CHECK(std::filesystem::exists(setting.out + "/" + trade.reference.picture));
  CHECK(csv_of(trade).size() == std::filesystem::file_size(setting.out + "/trade.csv"));
  // Errors fall along the samples within their bars; a slow machine may have left the last ones out.
  REQUIRE(trade.knobs.size() == 2);
  const MeasuredRun* before = nullptr;
  for (const std::string& name : trade.knobs[0].runs) {
    const MeasuredRun* now = named(trade, name);
    REQUIRE(now != nullptr);
    if (before != nullptr) CHECK(now->error.low <= before->error.high);
    before = now;
  }

  const Run again = setting.measure(command);
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK_THAT(again.err, Contains("are taken over"));
  const Trade second = read_trade(setting.out + "/trade.json");
  CHECK(second.reference.source == trade.reference.source);
  CHECK(second.reference.seconds == trade.reference.seconds);
  for (const MeasuredRun& one : trade.runs) {
    const MeasuredRun* kept = named(second, one.name);
    REQUIRE(kept != nullptr);
    REQUIRE(kept->repeats.size() >= one.repeats.size());
    CHECK(std::equal(one.repeats.begin(), one.repeats.end(), kept->repeats.begin()));
  }
  // The intervals are those of all repetitions, whichever of the two measurements made them.
  const ErrorsOfRuns errors = kept_errors(setting.out + "/errors.cbor", second);
  for (const MeasuredRun& one : second.runs) {
    if (!one.refused.empty()) continue;
    INFO(one.name);
    REQUIRE(errors.count(one.name) == 1);
    const Estimate of_all = errors.at(one.name).estimate();
    CHECK(one.error.low == of_all.low);
    CHECK(one.error.high == of_all.high);
  }

  std::filesystem::remove(setting.out + "/errors.cbor");
  const Run anew = setting.measure("--knobs spp --size 32x32 --budget 4");
  CHECK(anew.code == 0);
  CHECK_THAT(anew.err, Contains("errors.cbor is not there") && !Contains("are taken over"));
}

TEST_CASE("measure compares with a picture that it is given") {
  const Measuring setting;
  const std::string reference = setting.folder.file("reference.exr");
  REQUIRE(
      run_program("render " + setting.scene + " -o " + reference + " --size 40x32 --spp 64 --integrator path").code ==
      0);
  const Run run = setting.measure("--knobs spp --budget 5 --reference " + reference);
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Trade trade = read_trade(setting.out + "/trade.json");
  CHECK(trade.width == 40);
  CHECK(trade.height == 32);
  CHECK(trade.reference.source == reference);
  CHECK(trade.reference.own_noise > 0.0); // it has channels of its variance

  const Run other = setting.measure("--budget 5 --size 64x64 --reference " + reference);
  CHECK(other.code != 0);
  CHECK_THAT(other.err, Contains("reference.exr: is 40x32 pixels") && Contains("64x64"));
}

TEST_CASE("measure says what is wrong before it begins") {
  const Measuring setting;
  const auto refused = [&](const std::string& more, int code, const std::string& text) {
    const Run run = setting.measure(more);
    INFO(more);
    CHECK(run.code == code);
    CHECK_THAT(run.err, Contains(text));
  };
  refused("--knobs directons", 2, "did you mean \"directions\"");
  refused("--size 8x8", 2, "--size: expected WIDTHxHEIGHT");
  refused("--target 0", 2, "--target");
  refused("--set radiosity.directions=0", 3, "radiosity.directions");
  setting.folder.write("file", "");
  const Run run = run_program("measure " + setting.scene + " -o " + setting.folder.file("file") + "/out");
  CHECK(run.code != 0);
  CHECK_THAT(run.err, Contains("cannot create the folder"));
}

TEST_CASE("a measurement that Ctrl-C ends keeps what it has", "[long]") {
  const Measuring setting;
  // The shell sends the signal once, as soon as a second setting has its picture, and returns the program's exit code.
  const Run run = setting.measure("--knobs spp --size 32x32 --budget 600",
                                  "sh -c '\"$@\" & while kill -0 $! && ! [ -e \"$0\" ]; do sleep 0.1; done; "
                                  "kill -INT $!; wait $!' " +
                                      setting.out + "/pictures/spp-2.png");
  INFO(run.err);
  CHECK(run.code == 130);
  CHECK_THAT(run.err, Contains("interrupted: what was measured is kept"));
  CHECK_THAT(run.out, Contains("trade.json"));
  const Trade trade = read_trade(setting.out + "/trade.json");
  CHECK(named(trade, "spp-2") != nullptr);
  CHECK(kept_errors(setting.out + "/errors.cbor", trade).size() == trade.runs.size());
  CHECK(std::filesystem::exists(setting.out + "/report.html"));
}

TEST_CASE("an interrupted measurement keeps what it has", "[long]") {
  const Measuring setting;
  std::filesystem::create_directories(setting.out + "/pictures");
  MeasureOptions options;
  options.scene = setting.scene;
  options.folder = setting.out;
  options.knobs = {"spp"};
  options.size = {32, 32};
  RunControl run;
  run.stop = [&] { return std::filesystem::exists(setting.out + "/pictures/spp-2.png"); };
  Trade saved;
  const Measured measured = measure(api::Context("cpu"), options, run, [&](const Trade& trade) { saved = trade; });
  CHECK(measured.interrupted);
  CHECK(measured.trade.runs.size() == 2);
  CHECK(json_of(saved) == json_of(measured.trade));

  run.stop = [] { return true; };
  CHECK_THROWS_AS(measure(api::Context("cpu"), options, run, [](const Trade&) {}), Error);
}
