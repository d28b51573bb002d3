/// The front, recommendations, commands, and the files of a measurement.
#include "host/error.h"
#include "host/measure/trade.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace pointgi;
using Catch::Contains;

namespace {

MeasuredRun run_of(const std::string& name, double seconds, double error) {
  MeasuredRun run;
  run.name = name;
  run.repeats = {seconds};
  run.seconds = {seconds, seconds, seconds};
  run.error = {error, 0.9 * error, 1.1 * error};
  return run;
}

Trade small_trade() {
  Trade trade;
  trade.version = "1.2.3";
  trade.scene = "my room.toml";
  trade.device = "a device";
  trade.date = "2026-11-30";
  trade.overrides = {"camera.fov_deg=30"};
  trade.state = "0123";
  trade.width = 32;
  trade.height = 24;
  trade.budget_seconds = 10.0;
  trade.spent_seconds = 9.5;
  trade.reference = {"path tracer, twice 64 samples a pixel", "pictures/reference.png", 1e-4, 3.0};
  trade.runs = {run_of("own", 1.0, 0.01), run_of("spp-2", 0.5, 0.1), run_of("spp-128", 3.0, 0.001),
                run_of("bad", 2.0, 0.02)};
  trade.runs[1].setting = {{"render.spp=2"}, "spp", "2", "fmm"};
  trade.runs[1].stages = {{"fmm", 0.25}, {"render", 0.125}};
  trade.runs[1].memory_bytes = 123456789012ull;
  trade.runs[1].error.low = -0.5;
  trade.runs[1].picture = "pictures/spp-2.png";
  MeasuredRun refused;
  refused.name = "method-gather";
  refused.setting.overrides = {"radiosity.method=gather"};
  refused.refused = "too slow, \"far\" too slow";
  trade.runs.push_back(refused);
  trade.knobs = {{"spp", {"spp-2", "own", "spp-128"}, true, "falls"}};
  return trade;
}

std::string error_of(const std::string& path) {
  try {
    read_trade(path);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    return error.what();
  }
  return "(none)";
}

} // namespace

TEST_CASE("the front holds what no run beats in both, fastest first") {
  Trade trade = small_trade();
  CHECK(mark_front(trade) == std::vector<std::size_t>{1, 0, 2});
  CHECK_FALSE(trade.runs[3].on_front);
  CHECK_FALSE(trade.runs[4].on_front);

  SECTION("of equals one is on it") {
    trade.runs.push_back(run_of("twin", 1.0, 0.01));
    CHECK(mark_front(trade).size() == 3);
  }
  SECTION("an error below the reference's noise may be negative") {
    trade.runs.push_back(run_of("lucky", 2.0, -1e-6));
    CHECK(mark_front(trade) == std::vector<std::size_t>{1, 0, 5});
  }
}

TEST_CASE("a measurement recommends for an error and for a time") {
  const Trade trade = small_trade();
  CHECK(fastest_within_error(trade, 0.05) == std::optional<std::size_t>(0));
  CHECK(fastest_within_error(trade, 0.5) == std::optional<std::size_t>(1));
  CHECK(fastest_within_error(trade, 1e-5) == std::nullopt);
  CHECK(most_accurate_within(trade, 1.5) == std::optional<std::size_t>(0));
  CHECK(most_accurate_within(trade, 100.0) == std::optional<std::size_t>(2));
  CHECK(most_accurate_within(trade, 0.1) == std::nullopt);
  CHECK(command_of(trade, trade.runs[1]) == "pointgi render 'my room.toml' --set camera.fov_deg=30 --set render.spp=2");
}

TEST_CASE("trade.json comes back as it was written") {
  const test::TemporaryFolder folder;
  Trade trade = small_trade();
  trade.runs[3].bias = std::numeric_limits<double>::infinity(); // of a black reference
  const std::string text = json_of(trade);
  const Trade back = read_trade(folder.write("trade.json", text));
  CHECK(json_of(back) == text);
  REQUIRE(back.runs.size() == 5);
  CHECK(back.runs[1].memory_bytes == 123456789012ull);
  CHECK(back.runs[1].error.low == -0.5);
  CHECK(back.runs[1].stages.at("render") == 0.125);
  CHECK(back.runs[4].refused == "too slow, \"far\" too slow");
  CHECK(back.knobs[0].runs.size() == 3);
}

TEST_CASE("a damaged trade.json is refused by its name and what is wrong") {
  const test::TemporaryFolder folder;
  const std::string text = json_of(small_trade());
  CHECK_THAT(error_of(folder.file("none.json")), Contains("none.json") && Contains("cannot be read"));
  CHECK_THAT(error_of(folder.write("half.json", text.substr(0, text.size() / 2))), Contains("half.json"));
  const auto with = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json changed = nlohmann::json::parse(text);
    changed[nlohmann::json::json_pointer(pointer)] = value;
    return error_of(folder.write("changed.json", changed.dump()));
  };
  CHECK_THAT(with("/runs/1/name", 7), Contains("changed.json: runs.1.name") && Contains("expected a text"));
  CHECK_THAT(with("/runs/0/error", "far"), Contains("runs.0.error: expected an object"));
  CHECK_THAT(with("/width", 0), Contains("width"));
  CHECK_THAT(with("/runs", nlohmann::json::object()), Contains("runs: expected a list"));
  CHECK_THAT(error_of(folder.write("list.json", "[]")), Contains("expected an object"));
  nlohmann::json without = nlohmann::json::parse(text);
  without.erase("device");
  CHECK_THAT(error_of(folder.write("without.json", without.dump())), Contains("has no \"device\""));
}

TEST_CASE("trade.csv has a line a run, with as many fields as names") {
  const std::string text = csv_of(small_trade());
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  const auto commas = std::count(line.begin(), line.end(), ',');
  std::size_t lines = 0;
  for (; std::getline(in, line); ++lines)
    if (line.find('"') == std::string::npos) CHECK(std::count(line.begin(), line.end(), ',') == commas);
  CHECK(lines == 5);
  CHECK_THAT(text, Contains("\"too slow, \"\"far\"\" too slow\""));
}
