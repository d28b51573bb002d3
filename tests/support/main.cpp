#define CATCH_CONFIG_RUNNER
#include "tests/support/scans.h"
#include <catch2/catch.hpp>
#include <spdlog/spdlog.h>

int main(int argc, char** argv) {
  spdlog::set_level(spdlog::level::off); // what commands log is not what tests print
  const int result = Catch::Session().run(argc, argv);
  constexpr int skipped = 4; // SKIP_RETURN_CODE of tests/CMakeLists.txt
  return result == 0 && pointgi::test::something_skipped ? skipped : result;
}
