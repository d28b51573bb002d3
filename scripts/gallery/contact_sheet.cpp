// Puts PNG files side by side, made smaller: contact_sheet OUT.png COLUMNS WIDTH PICTURE...
// Says of each the mean of its values, from 0 to 1, as the file has them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <png.h>
#include <string>
#include <vector>

namespace {

struct Image {
  std::size_t width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

bool read(const char* path, Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, path) == 0) return false;
  png.format = PNG_FORMAT_RGB;
  image = {png.width, png.height, std::vector<unsigned char>(PNG_IMAGE_SIZE(png))};
  return png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) != 0;
}

bool write(const char* path, const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  return png_image_write_to_file(&png, path, 0, image.rgb.data(), 0, nullptr) != 0;
}

double mean(const Image& image) {
  double sum = 0.0;
  for (const unsigned char value : image.rgb)
    sum += value;
  return sum / (255.0 * static_cast<double>(image.rgb.size()));
}

/// Means over the pixels that fall into each of `to`'s cells, from (x0, y0) on; the aspect is kept by the caller.
void put(const Image& from, std::size_t x0, std::size_t y0, std::size_t width, std::size_t height, Image& to) {
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t left = x * from.width / width, right = std::max(left + 1, (x + 1) * from.width / width);
        const std::size_t top = y * from.height / height, below = std::max(top + 1, (y + 1) * from.height / height);
        double sum = 0.0;
        for (std::size_t j = top; j < below; ++j)
          for (std::size_t i = left; i < right; ++i)
            sum += from.rgb[3 * (j * from.width + i) + c];
        const double value = sum / static_cast<double>((right - left) * (below - top));
        to.rgb[3 * ((y0 + y) * to.width + x0 + x) + c] = static_cast<unsigned char>(std::lround(value));
      }
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: contact_sheet OUT.png COLUMNS WIDTH PICTURE...\n");
    return 2;
  }
  const std::size_t columns = std::strtoul(argv[2], nullptr, 10), width = std::strtoul(argv[3], nullptr, 10);
  const std::size_t height = width * 3 / 4, gap = 2, count = static_cast<std::size_t>(argc) - 4;
  if (columns == 0 || width == 0) return 2;
  const std::size_t across = std::min(columns, count), rows = (count + across - 1) / across;
  Image sheet{across * (width + gap) + gap, rows * (height + gap) + gap, {}};
  sheet.rgb.assign(3 * sheet.width * sheet.height, 255);
  for (std::size_t i = 0; i < count; ++i) {
    Image picture;
    if (!read(argv[4 + i], picture)) {
      std::fprintf(stderr, "%s: cannot be read as a PNG file\n", argv[4 + i]);
      return 3;
    }
    std::printf("mean of picture %zu: %.3f\n", i + 1, mean(picture));
    put(picture, gap + i % across * (width + gap), gap + i / across * (height + gap), width, height, sheet);
  }
  if (write(argv[1], sheet)) return 0;
  std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
  return 5;
}
