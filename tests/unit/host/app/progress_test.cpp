/// What is said of the time that work still takes.
#include "host/app/progress.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("the time left goes by the pace since the first share, not by the building of kernels before it") {
  TimeLeft left;
  CHECK(!left.seconds(0.0, 2.0));
  CHECK(!left.seconds(0.01, 8.0));  // eight seconds of kernels and a first tile
  CHECK(!left.seconds(0.011, 8.1)); // too little to go by
  REQUIRE(left.seconds(0.11, 9.0));
  CHECK(*left.seconds(0.11, 9.0) == Approx(8.9)); // a tenth a second
  CHECK(*left.seconds(0.61, 14.0) == Approx(3.9));
  CHECK(*left.seconds(1.0, 18.0) == Approx(0.0).margin(1e-9));
}

TEST_CASE("durations as text") {
  CHECK(duration_text(0.44) == "0.4 s");
  CHECK(duration_text(12.2) == "12 s");
  CHECK(duration_text(185.0) == "3 min 05 s");
  CHECK(duration_text(7800.0) == "2 h 10 min");
}
