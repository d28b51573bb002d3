#pragma once
/// Numbers in the text of scenes.
#include <cstdio>
#include <string>

namespace pointgi::test {

/// The double itself, read back.
inline std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

} // namespace pointgi::test
