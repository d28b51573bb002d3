/// Forecasts of a model whose times and errors are known, at other sizes and samples.
#include "host/measure/forecast.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

constexpr double pixel_seconds = 1e-6, own_noise = 0.4, stratified = 0.5;

/// relMSE `light` and half of the noise that the variances tell: samples are stratified.
MeasuredRun run_of(const std::string& name, std::vector<std::string> overrides, int samples, double light_seconds,
                   double light, int width, int height) {
  MeasuredRun run;
  run.name = name;
  run.setting.overrides = std::move(overrides);
  run.samples = samples;
  const double picture = pixel_seconds * width * height * samples;
  run.repeats = {light_seconds + picture};
  run.seconds = {run.repeats[0], run.repeats[0], run.repeats[0]};
  run.stages = {{"directions", light_seconds}, {"render", picture}};
  run.noise = samples > 1 ? own_noise / samples : std::numeric_limits<double>::infinity();
  const double error = light + stratified * own_noise / samples;
  run.error = {error, 0.98 * error, 1.02 * error};
  return run;
}

Trade trade_of() {
  Trade trade;
  trade.width = 100;
  trade.height = 80;
  const auto add = [&](auto... arguments) { trade.runs.push_back(run_of(arguments..., trade.width, trade.height)); };
  using Keys = std::vector<std::string>;
  add("own", Keys{}, 32, 2.0, 1e-3);
  add("spp-1", Keys{"render.spp=1"}, 1, 2.0, 1e-3);
  add("spp-4", Keys{"render.spp=4"}, 4, 2.0, 1e-3);
  add("spp-128", Keys{"render.spp=128"}, 128, 2.0, 1e-3);
  add("directions-64", Keys{"radiosity.directions=64"}, 32, 0.5, 5e-3);
  add("directions-2048", Keys{"radiosity.directions=2048", "render.spp=128"}, 128, 8.0, 1e-4);
  MeasuredRun refused;
  refused.name = "slow";
  refused.refused = "too slow";
  trade.runs.push_back(refused);
  return trade;
}

LightChoice named(const std::vector<LightChoice>& lights, const std::string& name) {
  for (const LightChoice& light : lights)
    if (light.name == name) return light;
  FAIL("no " << name);
  return {};
}

} // namespace

TEST_CASE("a setting's light and its noise are told apart by runs of other samples") {
  const Trade trade = trade_of();
  CHECK(noise_model(trade).factor == Approx(stratified).epsilon(0.01));
  CHECK(noise_model(trade).power == Approx(1.0).epsilon(0.002));
  const std::vector<LightChoice> lights = light_choices(trade);
  REQUIRE(lights.size() == 3);
  const LightChoice own = named(lights, "spp-128");
  CHECK(own.overrides.empty());
  CHECK(own.light_seconds == Approx(2.0));
  CHECK(own.seconds_a_sample == Approx(pixel_seconds));
  CHECK(own.light_error.value == Approx(1e-3).epsilon(0.01));
  CHECK(own.noise_a_sample == Approx(own_noise));
  CHECK(named(lights, "directions-2048").overrides == std::vector<std::string>{"radiosity.directions=2048"});
  CHECK(seconds_of(own, 640 * 480, 64) == Approx(2.0 + pixel_seconds * 640 * 480 * 64));
  CHECK(error_of(own, 64) == Approx(1e-3 + stratified * own_noise / 64).epsilon(0.01));
}

TEST_CASE("noise that falls faster than the samples grow is foretold so") {
  Trade trade = trade_of();
  for (MeasuredRun& run : trade.runs)
    if (run.refused.empty()) {
      const double light = run.error.value - stratified * own_noise / run.samples;
      run.error.value = light + 0.9 * own_noise / std::pow(run.samples, 1.3);
    }
  const NoiseModel model = noise_model(trade);
  CHECK(model.power == Approx(1.3).epsilon(0.01));
  CHECK(model.factor == Approx(0.9).epsilon(0.02));
  CHECK(model.noise(own_noise, 50) == Approx(0.9 * own_noise / std::pow(50, 1.3)).epsilon(0.02));
  CHECK(model.samples(own_noise, model.noise(own_noise, 50)) == Approx(50));
  CHECK(named(light_choices(trade), "spp-128").light_error.value == Approx(1e-3).epsilon(0.02));
}

TEST_CASE("noise is taken as it is where no two runs tell how far it goes") {
  Trade trade = trade_of();
  trade.runs = {trade.runs[0]};
  CHECK(noise_model(trade).factor == 1.0);
  CHECK(noise_model(trade).power == 1.0);
  CHECK(light_choices(trade)[0].noise_a_sample == Approx(own_noise));
}

TEST_CASE("two numbers of samples tell a factor and no power, and chance tells nothing") {
  Trade trade = trade_of();
  trade.runs = {trade.runs[0], trade.runs[2]}; // 32 and 4 samples
  CHECK(noise_model(trade).power == 1.0);
  CHECK(noise_model(trade).factor == Approx(stratified).epsilon(0.01));
  trade.runs[1].error = trade.runs[0].error;
  CHECK(noise_model(trade).factor == 1.0);
}

TEST_CASE("the fastest setting within an error, with the samples that it needs") {
  const std::vector<LightChoice> lights = light_choices(trade_of());
  constexpr double pixels = 640.0 * 480.0;
  const auto coarse = choose_for_error(lights, pixels, 0.02);
  REQUIRE(coarse);
  CHECK(coarse->light.name == "directions-64");
  CHECK(coarse->error <= 0.02);
  CHECK(error_of(coarse->light, coarse->samples - 1) > 0.02); // none too many
  const auto fine = choose_for_error(lights, pixels, 5e-4);
  REQUIRE(fine);
  CHECK(fine->light.name == "directions-2048");
  CHECK(fine->error <= 5e-4);
  CHECK_FALSE(choose_for_error(lights, pixels, 0.9e-4));
  // By hand, over all settings and samples.
  double least = 1e300;
  for (const LightChoice& light : lights)
    for (int samples = 1; samples <= 4096; ++samples)
      if (error_of(light, samples) <= 2e-3) least = std::min(least, seconds_of(light, pixels, samples));
  CHECK(choose_for_error(lights, pixels, 2e-3)->seconds == Approx(least));
}

TEST_CASE("the most accurate setting within a time, with the samples that fit into it") {
  const std::vector<LightChoice> lights = light_choices(trade_of());
  constexpr double pixels = 640.0 * 480.0;
  for (const double seconds : {1.0, 3.0, 10.0, 60.0, 300.0}) {
    INFO(seconds);
    const auto choice = choose_for_time(lights, pixels, seconds);
    REQUIRE(choice);
    CHECK(choice->seconds <= seconds);
    double least = 1e300;
    for (const LightChoice& light : lights)
      for (int samples = 1; samples <= 2000; ++samples)
        if (seconds_of(light, pixels, samples) <= seconds) least = std::min(least, error_of(light, samples));
    CHECK(choice->error == Approx(least));
  }
  CHECK_FALSE(choose_for_time(lights, pixels, 0.4));
}
