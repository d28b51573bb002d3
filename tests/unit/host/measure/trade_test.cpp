/// The front, recommendations, commands, and the files of a measurement.
#include "host/error.h"
#include "host/measure/trade.h"
#include "tests/support/promises.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trade.h"
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace pointgi;
using Catch::Contains;
using pointgi::test::small_trade;

namespace {

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
  CHECK(mark_front(trade) == std::vector<std::size_t>{1, 2, 3});
  for (const std::size_t at : {0u, 4u, 5u})
    CHECK_FALSE(trade.runs[at].on_front);

  SECTION("of equals one is on it") {
    trade.runs.push_back(trade.runs[1]);
    CHECK(mark_front(trade).size() == 3);
  }
  SECTION("an error below the reference's noise may be negative") {
    trade.runs.push_back(test::run_of("lucky", {}, 5.0, {-1e-5, -1e-4, 1e-5}));
    CHECK(mark_front(trade) == std::vector<std::size_t>{1, 2, 6});
  }
}

TEST_CASE("a measurement recommends for an error and for a time") {
  const Trade trade = small_trade();
  CHECK(fastest_within_error(trade, 6e-3) == std::optional<std::size_t>(1));
  CHECK(fastest_within_error(trade, 1e-3) == std::optional<std::size_t>(2));
  CHECK(fastest_within_error(trade, -1.0) == std::nullopt);
  // Of four times the pixels, for which 0.7 of the time is taken: 3.1 times as long.
  CHECK(full_seconds(trade, trade.runs[2]) == Approx(3.1 * 0.9));
  CHECK(most_accurate_within(trade, 1.0) == std::optional<std::size_t>(1));
  CHECK(most_accurate_within(trade, 2.8) == std::optional<std::size_t>(2));
  CHECK(most_accurate_within(trade, 100.0) == std::optional<std::size_t>(3));
  CHECK(most_accurate_within(trade, 0.1) == std::nullopt);
  CHECK(command_of(trade, trade.runs[1]) ==
        "pointgi render 'a </script><b> & '\\''room'\\''\u2028.toml' --set camera.fov_deg=30 "
        "--set radiosity.method=directions --set radiosity.directions=64");
}

TEST_CASE("trade.json comes back as it was written") {
  const test::TemporaryFolder folder;
  Trade trade = small_trade();
  trade.runs[0].bias = std::numeric_limits<double>::infinity(); // of a black reference
  const std::string text = json_of(trade);
  const Trade back = read_trade(folder.write("trade.json", text));
  CHECK(json_of(back) == text);
  REQUIRE(back.runs.size() == 6);
  CHECK(back.runs[1].memory_bytes == 123456789012ull);
  CHECK(back.runs[3].error.low == -1e-5);
  CHECK(back.runs[1].stages == trade.runs[1].stages);
  CHECK(back.runs[5].refused == trade.runs[5].refused);
  CHECK(back.knobs[0].runs.size() == 4);
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

TEST_CASE("a trade.json whose lists lie in each other without end is refused, not followed") {
  const test::TemporaryFolder folder;
  const std::string deep(200'000, '[');
  CHECK_THAT(error_of(folder.write("open.json", deep)), Contains("open.json: is no measurement"));
  CHECK_THAT(error_of(folder.write("closed.json", deep + std::string(deep.size(), ']'))),
             Contains("more than 32 deep"));
}

TEST_CASE("what a damaged trade.json holds is told in printable characters") {
  const test::TemporaryFolder folder;
  nlohmann::json changed = nlohmann::json::parse(json_of(small_trade()));
  changed["runs"] = "\x1b[31m\u2028\x7f";
  CHECK(test::is_printable(error_of(folder.write("value.json", changed.dump()))));
  changed = nlohmann::json::parse(json_of(small_trade()));
  changed["runs"][0]["stages"] = {{"\x1b[31m\u2028\x7f", "far"}};
  CHECK(test::is_printable(error_of(folder.write("key.json", changed.dump()))));
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
  CHECK(lines == 6);
  CHECK_THAT(text, Contains("\"more memory than the device has, \"\"far\"\" more\""));
}
