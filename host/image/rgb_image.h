#pragma once
#include <cstddef>
#include <vector>

namespace pointgi {

/// Linear RGB in memory, rows from the top, pixels from the left, three floats each.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<float> rgb;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

} // namespace pointgi
