#include "host/cl/device_clock.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

/// A launch that the host saw take `seconds`, nearly all of it waiting.
LaunchTimes seen_for(double seconds, std::uint64_t start_ns, std::uint64_t end_ns) {
  return {start_ns, end_ns, seconds, 0.9 * seconds};
}

} // namespace

TEST_CASE("a device's clock is believed where it agrees with the host's") {
  CHECK(seconds_of(seen_for(0.1, 1'000, 95'001'000)) == Approx(0.095));
  CHECK(seconds_of(seen_for(0.1, 0, 99'000'000)) == Approx(0.099)); // a clock may start at 0
  // A launch far shorter than the round trip.
  CHECK(seconds_of(seen_for(4e-4, 500, 2'500)) == Approx(2e-6));
  // Read late by the host's clock, a little fast: still the device's.
  CHECK(seconds_of(seen_for(0.1, 0, 101'000'000)) == Approx(0.101));
  // The driver compiled the kernel before it began to wait for it.
  CHECK(seconds_of({1'000, 6'000, 2.0, 1e-4}) == Approx(5e-6));
  // It ran the kernel in the call itself, and nothing was left to wait for.
  CHECK(seconds_of({0, 1'900'000'000, 2.0, 1e-6}) == Approx(1.9));
}

TEST_CASE("where the device's clock is nonsense, the host's counts") {
  for (const double seconds : {3e-4, 0.1, 7.0}) {
    CHECK(seconds_of(seen_for(seconds, 0, 0)) == seconds);              // it has none
    CHECK(seconds_of(seen_for(seconds, 123, 123)) == seconds);          // start = end
    CHECK(seconds_of(seen_for(seconds, 2'000'000, 1'000)) == seconds);  // end < start: 1.8e10 s
    CHECK(seconds_of(seen_for(seconds, 0, 60'000'000'000)) == seconds); // a minute
  }
  CHECK(seconds_of(seen_for(0.5, 0, 500'000)) == 0.5); // counts in microseconds
  CHECK(seconds_of({0, 0, 0.0, 0.0}) > 0.0);           // nobody divides by 0
}
