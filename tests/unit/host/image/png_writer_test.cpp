#include "host/image/png_writer.h"
#include "tests/unit/host/image/picture_fixture.h"
#include <catch2/catch.hpp>
#include <limits>
#include <png.h>

using namespace pointgi;
using namespace pointgi::test::picture;

namespace {

struct Png {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

Png read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&image, path.c_str()) != 0);
  CHECK(image.format == PNG_FORMAT_RGB); // 8 bit, three channels, no alpha
  CHECK((image.flags & PNG_IMAGE_FLAG_COLORSPACE_NOT_sRGB) == 0);
  Png png{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  png.rgb.resize(PNG_IMAGE_SIZE(image));
  REQUIRE(png_image_finish_read(&image, nullptr, png.rgb.data(), 0, nullptr) != 0);
  return png;
}

/// Red, green and blue of the pixel that this radiance makes through the whole writer.
std::vector<std::uint8_t> written(std::vector<float> radiance, double exposure_stops) {
  const Folder folder;
  const int width = static_cast<int>(radiance.size());
  PictureWriter writer(folder.file("a.exr"), width, 1, {0, width, 0, 1}, rgb_channels(), {}, exposure_stops);
  writer.write({0, 1, width, {radiance, radiance, radiance}});
  writer.finish(0.0);
  const Png png = read_png(folder.file("a.png"));
  std::vector<std::uint8_t> red;
  for (std::size_t x = 0; x < radiance.size(); ++x) {
    CHECK(png.rgb[3 * x] == png.rgb[3 * x + 1]);
    CHECK(png.rgb[3 * x] == png.rgb[3 * x + 2]);
    red.push_back(png.rgb[3 * x]);
  }
  return red;
}

} // namespace

TEST_CASE("known radiances give the bytes of sRGB", "[png]") {
  // 255 times the standard's curve: 0.001 gives 3.29, 0.18 117.65, 0.2139 127.46, 0.2143 127.57, 0.5 187.52, 0.9
  // 243.45.
  CHECK(written({0.0f, 0.001f, 0.18f, 0.2139f, 0.2143f, 0.5f, 0.9f, 1.0f}, 0.0) ==
        std::vector<std::uint8_t>{0, 3, 118, 127, 128, 188, 243, 255});
}

TEST_CASE("exposure is in stops and values are clamped", "[png]") {
  // 0.045 at two stops and 0.72 at minus two are 0.18.
  CHECK(written({0.045f, 0.3f}, 2.0) == std::vector<std::uint8_t>{118, 255});
  CHECK(written({0.72f, 4.0f, 8.0f}, -2.0) == std::vector<std::uint8_t>{118, 255, 255});
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(written({-1.0f, -inf, nan, inf, 1e30f, -0.0f}, 0.0) == std::vector<std::uint8_t>{0, 0, 0, 255, 255, 0});
  // 2^5000 is infinite: black times it is NaN, which is black; all light is white.
  CHECK(written({0.0f, 1e-30f}, 5000.0) == std::vector<std::uint8_t>{0, 255});
  CHECK(written({0.0f, 1e30f}, -5000.0) == std::vector<std::uint8_t>{0, 0});
}

TEST_CASE("every byte is the nearest to its place on the curve", "[png]") {
  for (int byte = 0; byte <= 255; ++byte) {
    const double encoded = byte / 255.0;
    const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    CHECK(int{display_byte(static_cast<float>(linear), 1.0f)} == byte);
  }
}

TEST_CASE("the PNG holds R, G and B wherever they stand among the channels, in order of rows", "[png]") {
  const Folder folder;
  const std::vector<ChannelName> channels = {{"PointId", true}, {"B", false}, {"A", false}, {"G", false}, {"R", false}};
  PictureWriter writer(folder.file("a.exr"), 10, 10, {4, 6, 3, 6}, channels, {}, 0.0);
  const std::vector<float> ones(4, 1.0f), zeros(4, 0.0f);
  // Two rows: the first red and black, the second black and blue; the third is missing.
  writer.write({3, 2, 2, {ones, {0, 0, 0, 1}, ones, zeros, {1, 0, 0, 0}}});
  writer.finish(0.0);
  const Png png = read_png(folder.file("a.png"));
  CHECK(png.width == 2);
  CHECK(png.height == 3);
  CHECK(png.rgb == std::vector<std::uint8_t>{255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("the PNG says that it is sRGB", "[png]") {
  const Folder folder;
  PngWriter png(folder.file("a.png"), 1, 1);
  const std::uint8_t pixel[3] = {1, 2, 3};
  png.write_row(pixel);
  png.close();
  png.commit();
  CHECK(bytes_of(folder.file("a.png")).find("sRGB") != std::string::npos);
}
