#include "host/image/picture_writer.h"
#include "host/error.h"
#include "host/image/exposure.h"
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

/// Of the channels whose names are `prefix` and R, G and B; absent where one is.
std::optional<std::array<std::size_t, 3>> colours_of(const std::vector<ChannelName>& channels,
                                                     const std::string& prefix) {
  std::array<std::size_t, 3> found{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string name = prefix + "RGB"[k];
    const auto at =
        std::find_if(channels.begin(), channels.end(), [&](const ChannelName& c) { return c.name == name; });
    if (at == channels.end()) return std::nullopt;
    found[k] = static_cast<std::size_t>(at - channels.begin());
  }
  return found;
}

PictureAttributes with_exposure(PictureAttributes attributes, bool chosen) {
  if (chosen) attributes.number[exposure_attribute] = 0.0; // its value comes in close()
  return attributes;
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
        const std::vector<ChannelName>& channels, const PictureAttributes& attributes,
        std::optional<double> exposure_stops)
      : exr_path(path), png_path(png_path_of(path)), window(pixel_window), channel_count(channels.size()),
        exposure(exposure_stops), next_row(pixel_window.y0),
        exr(path, full_width, full_height, pixel_window, channels, with_exposure(attributes, !exposure_stops)),
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
    albedo = colours_of(channels, "Albedo.");
    const auto is_alpha = [](const ChannelName& channel) { return channel.name == "A"; };
    const auto at = std::find_if(channels.begin(), channels.end(), is_alpha);
    if (at != channels.end()) alpha = static_cast<std::size_t>(at - channels.begin());
  }

  void measure(const Band& band) {
    const auto three = [&](const std::array<std::size_t, 3>& of, std::size_t at) {
      return std::array<float, 3>{band.values[of[0]][at], band.values[of[1]][at], band.values[of[2]][at]};
    };
    for (std::size_t at = 0; at < band.values[rgb[0]].size(); ++at)
      meter.add(three(rgb, at), alpha ? band.values[*alpha][at] : 1.0f,
                albedo ? three(*albedo, at) : std::array<float, 3>{0.5f, 0.5f, 0.5f});
  }

  /// One row; `colours`: three pointers to its values.
  void write_png_row(const std::array<const float*, 3>& colours, float scale) {
    for (std::size_t i = 0; i < png_row.size(); ++i)
      png_row[i] = display_byte(colours[i % 3][i / 3], scale);
    png.write_row(png_row.data());
  }

  void write_png_from_exr(double stops) {
    const auto scale = static_cast<float>(std::exp2(stops));
    const std::size_t width = png_row.size() / 3;
    exr.read_rows({"R", "G", "B"}, [&](const float* row) {
      write_png_row({row, row + width, row + 2 * width}, scale);
    });
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
  std::optional<double> exposure; ///< stops; absent: not chosen yet
  int next_row;
  bool finished = false;
  std::array<std::size_t, 3> rgb{};
  std::optional<std::array<std::size_t, 3>> albedo;
  std::optional<std::size_t> alpha;
  ExposureMeter meter;
  PngLight light;
  ExrWriter exr;
  PngWriter png;
  std::vector<std::uint8_t> png_row;
};

PictureWriter::PictureWriter(const std::string& exr_path, int full_width, int full_height, PixelWindow window,
                             const std::vector<ChannelName>& channels, const PictureAttributes& attributes,
                             std::optional<double> exposure_stops) {
  check_window(full_width, full_height, window);
  files_ = std::make_unique<Files>(exr_path, full_width, full_height, window, channels, attributes, exposure_stops);
}

PictureWriter::~PictureWriter() = default;

void PictureWriter::write(const Band& band) {
  Files& files = *files_;
  files.check(band);
  if (band.rows == 0) return;
  files.exr.write(band);
  files.measure(band);
  const float scale = static_cast<float>(std::exp2(files.exposure.value_or(0.0)));
  for (int y = 0; y < band.rows && files.exposure; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(band.width);
    files.write_png_row({band.values[files.rgb[0]].data() + row, band.values[files.rgb[1]].data() + row,
                         band.values[files.rgb[2]].data() + row},
                        scale);
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
    for (int y = 0; y < missing && files.exposure; ++y)
      files.png.write_row(files.png_row.data());
    files.next_row = files.window.y1;
  }
  // Both files are complete before either gets its name, so that a full disk keeps both old ones.
  const double stops = files.exposure ? *files.exposure : files.meter.stops();
  files.exr.close(render_seconds, stops);
  if (!files.exposure) files.write_png_from_exr(stops);
  files.light = {stops, files.meter.clipped_at(stops), files.meter.mean_at(stops), files.meter.lit_share()};
  files.png.close();
  files.exr.commit();
  files.png.commit();
}

const PngLight& PictureWriter::png_light() const {
  return files_->light;
}
const std::string& PictureWriter::exr_path() const {
  return files_->exr_path;
}
const std::string& PictureWriter::png_path() const {
  return files_->png_path;
}

} // namespace pointgi
