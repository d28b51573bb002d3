#include "host/available_memory.h"
#include <catch2/catch.hpp>

using namespace pointgi;

TEST_CASE("the machine tells what memory it has left") {
  const auto bytes = available_memory();
  REQUIRE(bytes);
  CHECK(*bytes > (1u << 20));               // or nothing would run
  CHECK(*bytes < (std::uint64_t{1} << 50)); // no machine of today
}
