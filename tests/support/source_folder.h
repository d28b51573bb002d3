#pragma once
/// Files of the project that tests read.
#include <cstdlib>
#include <string>

namespace pointgi::test {

/// Where the tests were built, or what POINTGI_TEST_SOURCES names: tests that were carried elsewhere
/// (scripts/check/gpu) have what they read with them.
inline std::string source_folder() {
  const char* folder = std::getenv("POINTGI_TEST_SOURCES");
  return folder != nullptr ? folder : POINTGI_SOURCE_DIR;
}

} // namespace pointgi::test
