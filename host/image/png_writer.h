#pragma once
/// The PNG half of PictureWriter: 8-bit sRGB rows through libpng into a temporary file.
#include <cstdint>
#include <memory>
#include <string>

namespace pointgi {

/// Radiance -> the byte of the PNG: sRGB of value · scale, clamped to [0, 255] and rounded; NaN is 0, +Inf is 255.
std::uint8_t display_byte(float radiance, float scale);

/// All functions throw Error(output).
class PngWriter {
public:
  PngWriter(const std::string& path, int width, int height);
  ~PngWriter();
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  /// The next row from the top: 3 * width bytes, RGB.
  void write_row(const std::uint8_t* rgb);

  /// All rows are there: ends the file, which still has its temporary name.
  void close();
  /// After close(): fsync and rename.
  void commit();

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pointgi
