#pragma once
/// The rows of a picture on their way from the device to files.
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi {

/// One channel of the EXR file: float, or 32-bit unsigned for ids.
struct ChannelName {
  std::string name; ///< "R", "Direct.G", "N.X", "PointId" …
  bool is_uint = false;
};

/// A band of whole rows, channel-planar: channel c, row y (counted from `first_row`), column x stands at
/// values[c][y * width + x]; an is_uint channel keeps its bits in the float's place (memcpy).
struct Band {
  int first_row = 0; ///< a row of the full image, as PixelWindow counts them: the first band starts at window.y0
  int rows = 0;
  int width = 0; ///< of the pixel window
  std::vector<std::vector<float>> values;
};

} // namespace pointgi
