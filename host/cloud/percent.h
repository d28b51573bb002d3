#pragma once
/// How messages name shares.
#include <cstdio>
#include <string>

namespace pointgi {

/// "12.3 %" of 0.123.
inline std::string percent(double share, int digits = 1) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f %%", digits, 100.0 * share);
  return text;
}

} // namespace pointgi
