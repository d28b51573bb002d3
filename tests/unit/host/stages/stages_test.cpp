#include "host/stages/stages.h"
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <thread>

using namespace pointgi;

TEST_CASE("a trace places launches by the device's clock, and by the host's where that is not to be believed") {
  using Clock = std::chrono::steady_clock;
  StageLog log;
  log.start("render");
  const Clock::time_point called = Clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  log.finish(1, "pixels");
  constexpr std::uint64_t uptime = 7'000'000'000'000; // the device's clock began two hours ago
  const auto after = [&](int ms) { return called + std::chrono::milliseconds(ms); };
  // Begun 1 ms after it was called, at once, 2 ms late, and without a clock.
  const std::vector<LaunchRecord> launches = {{"a", "", uptime + 1'000'000, uptime + 2'000'000, called, true},
                                              {"b", "", uptime + 2'000'000, uptime + 3'000'000, after(2), true},
                                              {"c", "", uptime + 5'000'000, uptime + 6'000'000, after(3), true},
                                              {"d", "", 0, 1'000'000, after(4), false}};
  const auto trace = nlohmann::json::parse(log.chrome_trace(launches));
  std::map<std::string, double> at;
  for (const auto& event : trace["traceEvents"])
    if (event["ph"] == "X") at[event["name"]] = event["ts"];
  const double begin = at["b"] - 2000.0; // of the call, microseconds
  CHECK(begin >= at["render"]);
  CHECK(at["a"] == Approx(begin + 1000.0).margin(0.1));
  CHECK(at["c"] == Approx(begin + 5000.0).margin(0.1));
  CHECK(at["d"] == Approx(begin + 4000.0).margin(0.1));
}
