#pragma once
#include "host/image/film_channels.h"
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// What the EXR file says about itself. "renderTimeSeconds" is added by the writer, which learns it last.
struct PictureAttributes {
  std::map<std::string, std::string> text; ///< "software", "pointgi/device", …
  std::map<std::string, double> number;    ///< "samplesPerPixel", …: kept as float attributes
  std::array<float, 16> world_to_camera{}; ///< row-major, row vectors as OpenEXR's M44f has them
  std::array<float, 16> world_to_ndc{};
};

/// What part of the full image the rows cover (interface.md: --pixelbounds); max is exclusive.
struct PixelWindow {
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

/// What the PNG of a picture shows.
struct PngLight {
  double exposure = 0.0;      ///< stops
  double clipped_share = 0.0; ///< of the pixels: some colour is 1 or more
  double mean = 0.0;          ///< of the values of sRGB, from 0 to 1
  double lit_share = 0.0;     ///< of the pixels: not black in the EXR
};

/// Writes OUT.exr (scan lines, ZIP, one part; displayWindow the full image, dataWindow the pixel window) and OUT.png
/// beside it (8 bit sRGB of R G B · 2^exposure, clamped, NaN as 0; the pixel window only, no alpha), row by row in
/// bounded memory (16 rows of the EXR, one of the PNG; where the exposure is chosen from the whole picture, the PNG is
/// written from the finished EXR) and atomically: temporary names in the same folder, fsync and
/// rename in finish(). A writer destroyed unfinished removes its temporary files and leaves any older picture whole.
/// Throws Error(output) naming the file and the remedy (folder missing, not writable, disk full, a name that does not
/// end in .exr), Error(usage) for a window outside the image, and Error(internal) for bands or channels that do not
/// fit, which only our own code can cause.
class PictureWriter {
public:
  /// Both files are created here, so that a wrong path costs no rendering. R, G and B must be among the channels.
  /// No `exposure_stops`: chosen (host/image/exposure.h), and kept as the attribute exposure_attribute.
  /// Compression takes as many threads as Imf::setGlobalThreadCount() allows; the bytes do not depend on it.
  PictureWriter(const std::string& exr_path, int full_width, int full_height, PixelWindow window,
                const std::vector<ChannelName>& channels, const PictureAttributes& attributes,
                std::optional<double> exposure_stops);
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  /// The next rows from the top; width must be the window's, and first_row the one after the last written.
  void write(const Band& band);

  /// Fills rows not yet written with zero, sets renderTimeSeconds, closes and renames both files. Once only.
  void finish(double render_seconds);

  /// After finish().
  const PngLight& png_light() const;

  const std::string& exr_path() const;
  const std::string& png_path() const;

private:
  struct Files;
  std::unique_ptr<Files> files_;
};

/// Where the PNG of a picture goes: "out/picture.exr" -> "out/picture.png". Throws Error(output) for another extension.
std::string png_path_of(const std::string& exr_path);

/// A whole EXR file in memory, for tests and tools: channel name -> width*height values, rows from the top of `window`.
struct Picture {
  int width = 0, height = 0;                               ///< of `window`, which is the file's dataWindow
  int full_width = 0, full_height = 0;                     ///< of its displayWindow
  PixelWindow window;                                      ///< counted from the corner of the displayWindow
  std::map<std::string, std::vector<float>> channels;      ///< all; uint channels converted by value, halfs exactly
  std::map<std::string, std::vector<std::uint32_t>> uints; ///< uint channels, exact (a float has 24 bits)
  PictureAttributes attributes; ///< those of type string, float and int, and the two matrices where present
};
/// Reads what PictureWriter writes and other flat, unsubsampled EXR files (the first part). Throws Error(input).
Picture read_exr(const std::string& path);

} // namespace pointgi
