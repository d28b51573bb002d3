#include "host/image/hdr_reader.h"
#include "host/error.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace pointgi {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr std::size_t longest_line = 4096; ///< of a header; a "line" beyond it is no text

/// How the resolution line orders the pixels.
struct Layout {
  int width = 0, height = 0;
  bool from_bottom = false, from_right = false;
};

class Decoder {
public:
  Decoder(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  RgbImage decode(std::size_t most_pixels) {
    read_header();
    const Layout layout = read_resolution(most_pixels);
    RgbImage image;
    image.width = layout.width;
    image.height = layout.height;
    std::vector<Rgbe> row(static_cast<std::size_t>(layout.width));
    for (int y = 0; y < layout.height; ++y) {
      row_ = y;
      read_row(row);
      if (layout.from_right) std::reverse(row.begin(), row.end());
      for (const Rgbe& pixel : row)
        append(pixel, image.rgb);
    }
    if (layout.from_bottom) flip(image);
    return image;
  }

private:
  [[noreturn]] void fail(std::size_t at, const std::string& what) const {
    throw Error(ErrorKind::input, path_ + ": byte " + std::to_string(at) + ": " + what);
  }

  [[noreturn]] void fail_short() const {
    fail(bytes_.size(),
         "the file ends in row " + std::to_string(row_) + " of its pixels; it is truncated, copy or export it again");
  }

  std::uint8_t next() {
    if (at_ >= bytes_.size()) fail_short();
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }

  /// The header's next line without its end.
  std::string_view line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos || end - at_ > longest_line)
      fail(std::min(at_ + longest_line, bytes_.size()),
           "the header has no end, expected lines of text, an empty one and the size; the file is truncated or no "
           "Radiance picture");
    std::string_view text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }

  void read_header() {
    if (bytes_.substr(0, 2) != "#?")
      fail(0, "the file does not begin with \"#?\", it is no Radiance picture whatever its name says; convert it to "
              ".hdr or .exr");
    line();
    for (;;) {
      line_at_ = at_;
      const std::string_view text = line();
      if (text.empty()) return;
      read_variable(text);
    }
  }

  void read_variable(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return; // a command that made the picture
    const std::string_view name = text.substr(0, equals), value = text.substr(equals + 1);
    if (name == "FORMAT" && value.find("32-bit_rle_rgbe") == std::string_view::npos)
      fail(line_at_, "the FORMAT is not 32-bit_rle_rgbe, the only one that is read; convert the picture to RGBE");
    if (name == "EXPOSURE") {
      const auto exposure = numbers<1>(value);
      for (double& factor : factor_)
        factor /= exposure[0];
    }
    if (name == "COLORCORR") {
      const auto correction = numbers<3>(value);
      for (std::size_t k = 0; k < 3; ++k)
        factor_[k] /= correction[k];
    }
  }

  template <std::size_t Count>
  std::array<double, Count> numbers(std::string_view text) const {
    std::array<double, Count> values{};
    for (double& value : values) {
      text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || !(value > 0.0) || !std::isfinite(value))
        fail(line_at_, "the EXPOSURE or COLORCORR is no number > 0; correct the line or leave it out");
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    return values;
  }

  /// "-Y 512 +X 1024" and the like.
  Layout read_resolution(std::size_t most_pixels) {
    line_at_ = at_;
    std::string_view text = line();
    const char y_sign = sign(text, 'Y');
    Layout layout;
    layout.height = side(text);
    const char x_sign = sign(text, 'X');
    layout.width = side(text);
    layout.from_bottom = y_sign == '+';
    layout.from_right = x_sign == '-';
    const std::size_t pixels = static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height);
    if (pixels > most_pixels)
      fail(line_at_, "the picture has " + std::to_string(layout.width) + " x " + std::to_string(layout.height) +
                         " pixels, expected " + std::to_string(most_pixels) + " at most; scale it down");
    // No code takes fewer bytes than four a row.
    if (static_cast<std::size_t>(layout.height) > (bytes_.size() - at_) / 4)
      fail(bytes_.size(),
           "the header promises " + std::to_string(layout.height) +
               " rows, more than a file of this size can hold; it is truncated, copy or export it again");
    return layout;
  }

  char sign(std::string_view& text, char axis) const {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.size() < 2 || (text[0] != '+' && text[0] != '-') || text[1] != axis)
      fail(line_at_, "the size of the picture is expected as \"-Y rows +X columns\", columns inside rows; the file is "
                     "damaged, or turned and must be turned back");
    const char found = text[0];
    text.remove_prefix(2);
    return found;
  }

  int side(std::string_view& text) const {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || value < 1 || value > hdr_side)
      fail(line_at_, "rows and columns are expected from 1 to " + std::to_string(hdr_side) + "; the file is damaged");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
  }

  /// A row of the new run-length code begins with 2, 2 and its length, which as a pixel would not be normalised.
  void read_row(std::vector<Rgbe>& row) {
    const bool may_be_new = row.size() >= 8 && row.size() < 32768;
    if (may_be_new && at_ + 4 <= bytes_.size() && bytes_[at_] == 2 && bytes_[at_ + 1] == 2 &&
        static_cast<std::uint8_t>(bytes_[at_ + 2]) < 128) {
      const std::size_t start = at_;
      at_ += 2;
      const std::size_t length = std::size_t{next()} << 8 | next();
      if (length != row.size())
        fail(start, "a row of " + std::to_string(length) + " pixels, expected " + std::to_string(row.size()) +
                        "; the file is damaged, copy or export it again");
      for (std::size_t component = 0; component < 4; ++component)
        read_component(row, component);
    } else {
      read_flat_or_old(row);
    }
  }

  /// Runs (128 + n, value) and literals (n, n values) of one component.
  void read_component(std::vector<Rgbe>& row, std::size_t component) {
    for (std::size_t x = 0; x < row.size();) {
      const std::size_t start = at_;
      const std::uint8_t code = next();
      const std::size_t count = code > 128 ? code - 128u : code;
      if (count == 0 || count > row.size() - x)
        fail(start, "a run of " + std::to_string(count) + " values in row " + std::to_string(row_) +
                        ", expected 1 to " + std::to_string(row.size() - x) +
                        "; the file is damaged, copy or export it again");
      if (code > 128) {
        const std::uint8_t value = next();
        for (std::size_t end = x + count; x < end; ++x)
          row[x][component] = value;
      } else {
        for (std::size_t end = x + count; x < end; ++x)
          row[x][component] = next();
      }
    }
  }

  /// Pixels as they are; (1, 1, 1, n) repeats the one before n times, the next such n * 256 times more, and so on.
  void read_flat_or_old(std::vector<Rgbe>& row) {
    unsigned shift = 0;
    for (std::size_t x = 0; x < row.size();) {
      const std::size_t start = at_;
      Rgbe pixel;
      for (std::uint8_t& byte : pixel)
        byte = next();
      if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
        row[x++] = pixel;
        shift = 0;
        continue;
      }
      const std::size_t count = shift > 24 ? 0 : std::size_t{pixel[3]} << shift;
      if (x == 0 || shift > 24 || count > row.size() - x)
        fail(start, "a run of " + std::to_string(count) + " pixels in row " + std::to_string(row_) + " after " +
                        std::to_string(x) + " of " + std::to_string(row.size()) +
                        "; the file is damaged, copy or export it again");
      std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
      x += count;
      shift += 8;
    }
  }

  void append(const Rgbe& pixel, std::vector<float>& rgb) const {
    const double unit = pixel[3] == 0 ? 0.0 : std::ldexp(1.0, pixel[3] - 136);
    for (std::size_t k = 0; k < 3; ++k)
      rgb.push_back(static_cast<float>(pixel[k] * unit * factor_[k]));
  }

  static void flip(RgbImage& image) {
    const std::size_t row = 3 * static_cast<std::size_t>(image.width);
    for (std::size_t top = 0, bottom = static_cast<std::size_t>(image.height) - 1; top < bottom; ++top, --bottom)
      std::swap_ranges(&image.rgb[top * row], &image.rgb[top * row] + row, &image.rgb[bottom * row]);
  }

  std::string_view bytes_;
  const std::string& path_;
  std::size_t at_ = 0;      ///< the next byte
  std::size_t line_at_ = 0; ///< where the header's line begins
  int row_ = 0;
  std::array<double, 3> factor_{1.0, 1.0, 1.0};
};

} // namespace

RgbImage decode_hdr(std::string_view bytes, const std::string& path, std::size_t most_pixels) {
  return Decoder(bytes, path).decode(most_pixels);
}

} // namespace pointgi
