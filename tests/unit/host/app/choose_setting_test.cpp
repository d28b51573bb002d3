/// Which setting a time or an error asks for, and what is found of a scene that was measured.
#include "host/app/choose_setting.h"
#include "host/measure/measure.h"
#include "host/measure/stored_trade.h"
#include "host/scene/presets.h"
#include "tests/support/cache_folder.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <filesystem>

using namespace pointgi;
using Catch::Contains;

namespace {

/// 100 x 100 pixels; the scene's own takes 2 s, few directions half a second.
Trade trade_of(const std::string& scene) {
  Trade trade;
  trade.version = POINTGI_VERSION;
  trade.scene = scene;
  trade.device = "a device";
  trade.date = "2026-11-30";
  trade.width = trade.height = trade.full_width = trade.full_height = 100;
  const auto add = [&](const std::string& name, const std::vector<std::string>& overrides, double light, double error) {
    MeasuredRun run;
    run.name = name;
    run.setting.overrides = overrides;
    run.samples = 32;
    run.repeats = {light + 0.32};
    run.seconds = {run.repeats[0], run.repeats[0], run.repeats[0]};
    run.stages = {{"directions", light}, {"render", 0.32}}; // 1e-6 s a sample
    run.noise = 0.01;
    run.error = {error + 0.01, error + 0.009, error + 0.011};
    trade.runs.push_back(run);
  };
  add("own", {}, 2.0, 0.001);
  add("directions-32", {"radiosity.directions=32", "radiosity.method=directions"}, 0.5, 0.02);
  return trade;
}

constexpr double pixels = 1e6;

} // namespace

TEST_CASE("a time leaves out settings that are too slow for it, and says what comes out") {
  RenderOptions options;
  options.seconds = 4.0;
  const auto hasty = choose_by_trade(trade_of("a"), options, pixels, 1.0);
  REQUIRE(hasty);
  CHECK(hasty->overrides == std::vector<std::string>{"radiosity.directions=32", "radiosity.method=directions"});
  CHECK(hasty->goal.until == 4.0);
  CHECK(hasty->goal.light_error == Approx(0.02));
  CHECK(hasty->goal.seconds_a_sample == Approx(1.0));
  CHECK_THAT(hasty->told, Contains("radiosity.directions=32") && Contains("relMSE"));
  options.seconds = 400.0;
  CHECK(choose_by_trade(trade_of("a"), options, pixels, 1.0)->overrides.empty());
  SECTION("a time that no setting keeps takes the fastest, and says so") {
    options.seconds = 0.1;
    const auto none = choose_by_trade(trade_of("a"), options, pixels, 0.0);
    CHECK_THAT(none->told, Contains("no measured setting is so fast"));
    CHECK(none->overrides.size() == 2);
  }
}

TEST_CASE("an error takes the fastest setting that reaches it, within a time where both are given") {
  RenderOptions options;
  options.error = 0.05;
  CHECK(choose_by_trade(trade_of("a"), options, 1e4, 0.0)->overrides.size() == 2);
  CHECK(choose_by_trade(trade_of("a"), options, pixels, 0.0)->overrides.empty()); // fewer samples, of many pixels
  options.error = 0.01;
  const auto fine = choose_by_trade(trade_of("a"), options, pixels, 0.0);
  CHECK(fine->overrides.empty());
  CHECK(fine->error <= 0.01);
  options.error = 0.0005;
  CHECK_THAT(choose_by_trade(trade_of("a"), options, pixels, 0.0)->told,
             Contains("no measured setting reaches 0.0005"));
  options.error = 0.01;
  options.seconds = 5.0; // the error would take half a minute
  const auto both = choose_by_trade(trade_of("a"), options, pixels, 0.0);
  CHECK_THAT(both->told, Contains("0.01 would take"));
  CHECK(both->seconds <= 5.0);
}

TEST_CASE("what a picture will take is known where its settings were measured") {
  const auto known = forecast_of(trade_of("a"), {}, 64, pixels);
  REQUIRE(known);
  CHECK(known->seconds == Approx(2.0 + 64.0));
  CHECK(known->error == Approx(0.001 + 0.005));
  CHECK_FALSE(forecast_of(trade_of("a"), {"radiosity.directions=7"}, 64, pixels));
}

TEST_CASE("presets are chosen by what they reached on scenes of the kind") {
  RenderOptions options;
  options.input = "a.toml";
  for (const Preset& preset : presets()) {
    const auto reached = errors_of_kind(preset.name, "statue");
    REQUIRE(reached);
    options.error = 1.01 * reached->second;
    CHECK(choose_by_presets("statue", options, 1.0, 0.0).preset == preset.name);
  }
  options.error = {};
  options.seconds = 100.0;
  CHECK(choose_by_presets("statue", options, 1.0, 0.0).preset == presets().back().name);
  CHECK(choose_by_presets("statue", options, 1000.0, 0.0).preset == presets().front().name);
  CHECK_THAT(choose_by_presets("statue", options, 1.0, 0.0).setting.told, Contains("pointgi measure a.toml"));
}

TEST_CASE("a measurement is found again for its scene and device, until the scene changes") {
  const test::CacheFolder cache;
  const test::TemporaryFolder folder;
  const std::string scene = folder.file("scene.toml");
  const auto write = [&](const std::string& text) { std::ofstream(scene) << text; };
  write(test::small_scene());
  Trade trade = trade_of(scene);
  MeasureOptions measured;
  measured.scene = scene;
  trade.state = state_of(measured);
  store_trade(trade);
  RenderOptions options;
  options.input = scene;
  REQUIRE(trade_for(options, "a device"));
  CHECK(trade_for(options, "a device")->runs.size() == trade.runs.size());
  CHECK_FALSE(trade_for(options, "another device"));
  SECTION("by another name of the file, too") {
    options.input = folder.file("./scene.toml");
    CHECK(trade_for(options, "a device"));
  }
  SECTION("not where the scene has changed") {
    write(std::string(test::small_scene()) + "\n# new\n");
    CHECK_FALSE(trade_for(options, "a device"));
  }
  SECTION("not for other settings, but for those of the picture") {
    options.overrides = {"render.spp=8"};
    CHECK(trade_for(options, "a device"));
    options.overrides = {"camera.fov_deg=30"};
    CHECK_FALSE(trade_for(options, "a device"));
    trade.overrides = options.overrides;
    measured.overrides = options.overrides;
    trade.state = state_of(measured);
    store_trade(trade);
    CHECK(trade_for(options, "a device"));
  }
  SECTION("where it was compared with a file, too") {
    trade.reference.file = measured.reference_file = folder.file("truth.exr");
    trade.state = state_of(measured);
    store_trade(trade);
    CHECK(trade_for(options, "a device"));
  }
  SECTION("in place of none that has more runs") {
    trade.runs.pop_back();
    store_trade(trade);
    CHECK(trade_for(options, "a device")->runs.size() == trade.runs.size() + 1);
  }
  SECTION("not of another version") {
    trade.version = "0.0.0";
    store_trade(trade);
    CHECK_FALSE(trade_for(options, "a device"));
  }
  SECTION("--trade takes one from elsewhere") {
    std::filesystem::create_directory(folder.file("measured"));
    std::ofstream(folder.file("measured/trade.json")) << json_of(trade);
    options.trade = folder.file("measured");
    CHECK(trade_for(options, "another device"));
    options.trade = folder.file("nothing.json");
    CHECK_THROWS_WITH(trade_for(options, "another device"), Contains("nothing.json: cannot be read"));
  }
}
