#pragma once
/// A measurement of speed against accuracy that nobody made.
#include "host/measure/trade.h"
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pointgi::test {

inline MeasuredRun run_of(const std::string& name, std::vector<std::string> overrides, double seconds, Estimate error) {
  MeasuredRun run;
  run.name = name;
  run.setting = {std::move(overrides), "radiosity.directions", name.substr(name.rfind('-') + 1), "directions"};
  run.repeats = {seconds};
  run.seconds = {seconds, 0.9 * seconds, 1.1 * seconds};
  run.stages = {{"octree", 0.1 * seconds}, {"render", 0.7 * seconds}};
  run.memory_bytes = 123456789012ull;
  run.error = error;
  run.ssim = 0.99;
  run.picture = "pictures/" + name + ".png";
  return run;
}

/// Five runs and a refused one. The scene's own is not on the front; one has no finite error, one less than can be
/// told. Names and texts hold what shells, CSV and HTML take for signs of their own.
inline Trade small_trade() {
  Trade trade;
  trade.version = "0.0.0";
  trade.scene = "a </script><b> & 'room'\u2028.toml";
  trade.device = "a device";
  trade.date = "2026-01-02";
  trade.overrides = {"camera.fov_deg=30"};
  trade.state = "0123";
  trade.width = 16;
  trade.height = 12;
  trade.full_width = 32;
  trade.full_height = 24;
  trade.budget_seconds = 300.0;
  trade.spent_seconds = 290.0;
  trade.reference = {"path tracer", "pictures/reference.png", 1e-5, 90.0};
  const auto directions = [](const char* count) {
    return std::vector<std::string>{"radiosity.method=directions", std::string("radiosity.directions=") + count};
  };
  trade.runs = {run_of("own", {}, 2.0, {1.0 / 1024.0, 9e-4, 1.1e-3}),
                run_of("directions-64", directions("64"), 0.3, {5e-3, 4e-3, 6e-3}),
                run_of("directions-512", directions("512"), 0.9, {4.1e-4, 4e-4, 4.2e-4}),
                run_of("directions-4096", directions("4096"), 8.125, {-1e-6, -1e-5, 8e-6}),
                run_of("directions-1", directions("1"), 0.31, {std::numeric_limits<double>::infinity(), 0.0, 0.0})};
  MeasuredRun refused = run_of("directions-65536", directions("65536"), 0.0, {});
  refused.refused = "more memory than the device has, \"far\" more";
  refused.picture.clear();
  trade.runs.push_back(refused);
  trade.knobs = {{"radiosity.directions",
                  {"directions-1", "directions-64", "directions-512", "directions-4096"},
                  true,
                  "falls",
                  "",
                  {"1", "64", "512", "4096"}},
                 {"caustics.photons", {}, true, "no specular surface"}};
  mark_front(trade);
  return trade;
}

} // namespace pointgi::test
