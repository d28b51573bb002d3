#include "host/image/picture_writer.h"
#include "host/error.h"
#include "host/image/exr_writer.h"
#include "host/image/png_writer.h"
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace pointgi {

namespace {

void check_window(int full_width, int full_height, PixelWindow window) {
  if (full_width > 0 && full_height > 0 && 0 <= window.x0 && window.x0 < window.x1 && window.x1 <= full_width &&
      0 <= window.y0 && window.y0 < window.y1 && window.y1 <= full_height)
    return;
  throw Error(ErrorKind::usage, "pixel window x " + std::to_string(window.x0) + " to " + std::to_string(window.x1) +
                                    ", y " + std::to_string(window.y0) + " to " + std::to_string(window.y1) +
                                    ": expected a non-empty part of the image of " + std::to_string(full_width) + "x" +
                                    std::to_string(full_height) +
                                    " pixels; give --pixelbounds x0,x1,y0,y1 with x1 and y1 one past the last pixel");
}

/// Index of the channel `name`; also refuses a second one of that name, of which OpenEXR would keep one.
std::size_t index_of(const std::vector<ChannelName>& channels, const std::string& name) {
  std::size_t found = channels.size(), count = 0;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name != name) continue;
    found = c;
    ++count;
  }
  if (count != 1)
    throw Error(ErrorKind::internal,
                "picture channel \"" + name + "\": " + std::to_string(count) + " of that name, expected one");
  return found;
}

} // namespace

std::string png_path_of(const std::string& exr_path) {
  std::filesystem::path path(exr_path);
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension != ".exr")
    throw Error(ErrorKind::output, "\"" + exr_path +
                                       "\": the name of the picture must end in .exr (a .png is written beside it); "
                                       "give one like out/picture.exr");
  return path.replace_extension(".png").string();
}

struct PictureWriter::Files {
  Files(const std::string& path, int full_width, int full_height, PixelWindow pixel_window,
        const std::vector<ChannelName>& channels, const PictureAttributes& attributes, double exposure_stops)
      : exr_path(path), png_path(png_path_of(path)), window(pixel_window), channel_count(channels.size()),
        scale(static_cast<float>(std::exp2(exposure_stops))), next_row(pixel_window.y0),
        exr(path, full_width, full_height, pixel_window, channels, attributes),
        png(png_path, pixel_window.x1 - pixel_window.x0, pixel_window.y1 - pixel_window.y0),
        png_row(3 * static_cast<std::size_t>(pixel_window.x1 - pixel_window.x0)) {
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t i = 0; i < 3; ++i) {
      rgb[i] = index_of(channels, names[i]);
      if (channels[rgb[i]].is_uint)
        throw Error(ErrorKind::internal, std::string("picture channel \"") + names[i] + "\": expected floats");
    }
    for (const ChannelName& channel : channels)
      index_of(channels, channel.name);
  }

  void check(const Band& band) const {
    const std::size_t size =
        static_cast<std::size_t>(std::max(band.rows, 0)) * static_cast<std::size_t>(png_row.size() / 3);
    bool fits = band.width == window.x1 - window.x0 && band.rows >= 0 && band.rows <= window.y1 - next_row &&
                band.first_row == next_row && band.values.size() == channel_count;
    for (const std::vector<float>& values : band.values)
      fits = fits && values.size() == size;
    if (fits) return;
    throw Error(ErrorKind::internal,
                exr_path + ": a band of " + std::to_string(band.rows) + " rows of " + std::to_string(band.width) +
                    " pixels in " + std::to_string(band.values.size()) + " channels from row " +
                    std::to_string(band.first_row) + " on does not fit, expected at most " +
                    std::to_string(window.y1 - next_row) + " rows of " + std::to_string(window.x1 - window.x0) +
                    " pixels in " + std::to_string(channel_count) + " channels from row " + std::to_string(next_row) +
                    " on");
  }

  std::string exr_path, png_path;
  PixelWindow window;
  std::size_t channel_count;
  float scale; ///< 2^exposure
  int next_row;
  bool finished = false;
  std::size_t rgb[3] = {0, 0, 0};
  ExrWriter exr;
  PngWriter png;
  std::vector<std::uint8_t> png_row;
};

PictureWriter::PictureWriter(const std::string& exr_path, int full_width, int full_height, PixelWindow window,
                             const std::vector<ChannelName>& channels, const PictureAttributes& attributes,
                             double exposure_stops) {
  check_window(full_width, full_height, window);
  files_ = std::make_unique<Files>(exr_path, full_width, full_height, window, channels, attributes, exposure_stops);
}

PictureWriter::~PictureWriter() = default;

void PictureWriter::write(const Band& band) {
  Files& files = *files_;
  files.check(band);
  if (band.rows == 0) return;
  files.exr.write(band);
  for (int y = 0; y < band.rows; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(band.width);
    for (std::size_t x = 0; x < static_cast<std::size_t>(band.width); ++x)
      for (std::size_t c = 0; c < 3; ++c)
        files.png_row[3 * x + c] = display_byte(band.values[files.rgb[c]][row + x], files.scale);
    files.png.write_row(files.png_row.data());
  }
  files.next_row += band.rows;
}

void PictureWriter::finish(double render_seconds) {
  Files& files = *files_;
  if (files.finished) throw Error(ErrorKind::internal, files.exr_path + ": finished twice");
  files.finished = true;
  if (const int missing = files.window.y1 - files.next_row; missing > 0) {
    files.exr.write_zeros(missing);
    std::fill(files.png_row.begin(), files.png_row.end(), std::uint8_t{0});
    for (int y = 0; y < missing; ++y)
      files.png.write_row(files.png_row.data());
    files.next_row = files.window.y1;
  }
  // Both files are complete before either gets its name, so that a full disk keeps both old ones.
  files.exr.close(render_seconds);
  files.png.close();
  files.exr.commit();
  files.png.commit();
}

const std::string& PictureWriter::exr_path() const {
  return files_->exr_path;
}
const std::string& PictureWriter::png_path() const {
  return files_->png_path;
}

} // namespace pointgi
