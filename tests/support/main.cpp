#define CATCH_CONFIG_RUNNER
#include "tests/support/scans.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <spdlog/spdlog.h>

int main(int argc, char** argv) {
  // Not the user's folder: what `pointgi profile` stored there would choose the variants that are tested.
  setenv("POINTGI_CACHE_DIR", POINTGI_TEST_CACHE, 0);
  spdlog::set_level(spdlog::level::off); // what commands log is not what tests print
  const int result = Catch::Session().run(argc, argv);
  constexpr int skipped = 4; // SKIP_RETURN_CODE of tests/CMakeLists.txt
  // Catch returns the number of failures, and four of them are not "skipped".
  if (result != 0) return 1;
  return pointgi::test::something_skipped ? skipped : 0;
}
