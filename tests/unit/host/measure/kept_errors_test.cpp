/// Intervals of a measurement that goes on.
#include "host/measure/kept_errors.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;

namespace {

constexpr int width = 45, height = 30; // no whole tiles

std::vector<double> errors_of(unsigned seed) {
  std::mt19937 engine(seed);
  std::exponential_distribution<double> one;
  std::vector<double> errors(width * height);
  for (double& error : errors)
    error = one(engine);
  return errors;
}

void repeat(ErrorOfRepeats& errors, unsigned seed) {
  errors.add(errors_of(seed), width, height, 1e-3 * seed);
}

/// A trade with a run of that many repetitions.
Trade trade_of(const std::string& name, std::size_t repeats) {
  Trade trade;
  trade.state = "0123";
  trade.width = width;
  trade.height = height;
  MeasuredRun run;
  run.name = name;
  run.repeats.assign(repeats, 1.0);
  trade.runs.push_back(run);
  return trade;
}

bool same(const Estimate& a, const Estimate& b) {
  return a.value == b.value && a.low == b.low && a.high == b.high;
}

} // namespace

TEST_CASE("a measurement that goes on finds the interval that it would have found at once") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("errors.cbor");
  ErrorOfRepeats whole, begun;
  for (const unsigned seed : {1u, 2u, 3u})
    repeat(whole, seed);
  for (const std::size_t count : {1u, 2u}) {
    repeat(begun, static_cast<unsigned>(count));
    keep_errors({{"own", begun}}, trade_of("own", count), path);
    ErrorsOfRuns kept = kept_errors(path, trade_of("own", count));
    REQUIRE(kept.count("own") == 1);
    ErrorOfRepeats& resumed = kept.at("own");
    CHECK(same(resumed.estimate(), begun.estimate()));
    for (unsigned seed = static_cast<unsigned>(count) + 1; seed <= 3; ++seed)
      repeat(resumed, seed);
    CHECK(same(resumed.estimate(), whole.estimate()));
  }
}

TEST_CASE("of errors that are kept those count that the measurement's runs have") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("errors.cbor");
  ErrorOfRepeats first, both;
  repeat(first, 1);
  repeat(both, 1);
  repeat(both, 2);
  keep_errors({{"own", both}}, trade_of("own", 2), path);

  SECTION("one more is kept, as when the program was ended between two files") {
    const ErrorsOfRuns kept = kept_errors(path, trade_of("own", 1));
    REQUIRE(kept.count("own") == 1);
    CHECK(kept.at("own").estimate().value == first.estimate().value);
  }
  SECTION("fewer are kept, or none") {
    CHECK(kept_errors(path, trade_of("own", 3)).empty());
    CHECK(kept_errors(path, trade_of("own", 0)).empty());
    CHECK(kept_errors(path, trade_of("other", 1)).empty());
    CHECK(kept_errors(folder.file("none"), trade_of("own", 1)).empty());
  }
  SECTION("they are of another scene or size") {
    Trade other = trade_of("own", 2);
    other.state = "4567";
    CHECK(kept_errors(path, other).empty());
    other = trade_of("own", 2);
    other.width = width + 8;
    CHECK(kept_errors(path, other).empty());
  }
  SECTION("the file is damaged or none of ours") {
    const std::string bytes = test::contents(path);
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, bytes.size() / 2, bytes.size() - 1}) {
      folder.write("errors.cbor", bytes.substr(0, size));
      CHECK(kept_errors(path, trade_of("own", 1)).empty());
    }
    for (const char* other : {"\xf6", "\x80", "\xa0", "\x18"}) { // null, a list, an object, half a number
      folder.write("errors.cbor", other);
      CHECK(kept_errors(path, trade_of("own", 1)).empty());
    }
  }
  SECTION("the file has lists, objects, texts or bytes that lie in each other without end") {
    for (const char* level : {"\x81", "\x9f", "\xa1\x61k", "\xbf\x61k", "\x7f", "\x5f", "\xc1"}) {
      std::string bytes;
      for (int i = 0; i < 200'000; ++i)
        bytes += level;
      folder.write("errors.cbor", bytes);
      CHECK(kept_errors(path, trade_of("own", 1)).empty());
    }
  }
}
