/// Radiance pictures: every code and order of the rows, what the header says of the values, and damaged files.
#include "host/error.h"
#include "host/image/hdr_reader.h"
#include "tests/support/hdr_bytes.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr std::size_t many = 1u << 20;

std::string error_of(const std::string& bytes, std::size_t most_pixels = many) {
  try {
    decode_hdr(bytes, "sky.hdr", most_pixels);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::input);
    CHECK_FALSE(error.remedy().empty());
    return error.what();
  }
  return "";
}

/// Runs, noise, black and the pixels that look like codes: (2, 2, ..) may not open a row, (1, 1, 1, ..) not be flat.
std::vector<Rgbe> pixels(int width, int height) {
  std::mt19937 random(7);
  std::vector<Rgbe> all;
  for (int i = 0; i < width * height; ++i) {
    const auto byte = [&] { return static_cast<std::uint8_t>(random() >> 24); };
    Rgbe pixel{static_cast<std::uint8_t>(128 | byte()), byte(), byte(), static_cast<std::uint8_t>(100 + byte() % 60)};
    if (i % 7 == 0) pixel = {0, 0, 0, 0};
    if (i % width > width / 2) pixel = {200, 100, 50, 130};
    all.push_back(pixel);
  }
  return all;
}

} // namespace

TEST_CASE("an hdr picture reads the same in each of its codes") {
  // 600 columns: runs of more than 127 and of more than 255. 7: too narrow for the new code.
  const auto [width, height] = GENERATE(std::pair(600, 3), std::pair(8, 5), std::pair(7, 4), std::pair(1, 1));
  const std::vector<Rgbe> truth = pixels(width, height);
  for (const HdrCode code : {HdrCode::flat, HdrCode::old_runs, HdrCode::new_runs}) {
    if (code == HdrCode::new_runs && width < 8) continue;
    const RgbImage image = decode_hdr(hdr_file(width, height, truth, code), "sky.hdr", many);
    REQUIRE(image.width == width);
    REQUIRE(image.height == height);
    REQUIRE(image.rgb.size() == 3 * truth.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double unit = truth[i][3] == 0 ? 0.0 : std::exp2(truth[i][3] - 136.0);
        wrong += static_cast<double>(image.rgb[3 * i + k]) != truth[i][k] * unit;
      }
    CHECK(wrong == 0);
  }
}

TEST_CASE("an hdr picture's header says where its rows begin and by what its values were multiplied") {
  std::string body;
  for (const float value : {1.0f, 2.0f, 3.0f, 4.0f})
    append_bytes(body, rgbe(value, value, value));
  const auto red = [&](const std::string& variables, const std::string& signs) {
    const RgbImage image = decode_hdr(hdr_header(2, 2, variables, signs) + body, "sky.hdr", many);
    return std::vector<float>{image.rgb[0], image.rgb[3], image.rgb[6], image.rgb[9]};
  };
  const std::string format = "FORMAT=32-bit_rle_rgbe\n";
  CHECK(red(format, "-+") == std::vector<float>{1, 2, 3, 4});
  CHECK(red(format, "++") == std::vector<float>{3, 4, 1, 2});
  CHECK(red(format, "--") == std::vector<float>{2, 1, 4, 3});
  CHECK(red(format, "+-") == std::vector<float>{4, 3, 2, 1});
  CHECK(red("rpict -vp 0 0 0\n" + format + "EXPOSURE= 4\nEXPOSURE=0.5\nSOFTWARE=a=b\n", "-+") ==
        std::vector<float>{0.5f, 1, 1.5f, 2});
  const RgbImage corrected = decode_hdr(hdr_header(2, 2, "COLORCORR=1 2 4\n") + body, "sky.hdr", many);
  CHECK(corrected.rgb[0] == 1.0f);
  CHECK(corrected.rgb[1] == 0.5f);
  CHECK(corrected.rgb[2] == 0.25f);
  CHECK(decode_hdr("#?RGBE\r\n\r\n-Y 2 +X 2\r\n" + body, "sky.hdr", many).rgb[9] == 4.0f);
}

TEST_CASE("an hdr file that is none says what is wrong, and at which byte") {
  using Catch::Contains;
  CHECK_THAT(error_of(""), Contains("sky.hdr: byte 0") && Contains("#?"));
  CHECK_THAT(error_of("P6\n"), Contains("Radiance picture"));
  CHECK_THAT(error_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"), Contains("header has no end"));
  CHECK_THAT(error_of("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n...."),
             Contains("byte 11") && Contains("FORMAT"));
  CHECK_THAT(error_of("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n...."), Contains("EXPOSURE"));
  CHECK_THAT(error_of("#?RADIANCE\nEXPOSURE=nan\n\n-Y 1 +X 1\n...."), Contains("EXPOSURE"));
  CHECK_THAT(error_of("#?RADIANCE\nCOLORCORR=1 2\n\n-Y 1 +X 1\n...."), Contains("COLORCORR"));
  CHECK_THAT(error_of("#?RADIANCE\n\n+X 1 -Y 1\n...."), Contains("byte 12") && Contains("columns inside rows"));
  for (const char* size : {"-Y 0 +X 1", "-Y 1 +X -1", "-Y 65537 +X 1", "-Y 1 +X 99999999999", "-Y 1 +X", "-Y x +X 1"})
    CHECK_THAT(error_of(std::string("#?RADIANCE\n\n") + size + "\n...."), Contains("byte 12"));
  CHECK_THAT(error_of(hdr_header(40000, 40000) + std::string(400000, 'x')), Contains("scale it down"));
  CHECK_THAT(error_of(hdr_header(10, 1000) + std::string(3999, 'x')), Contains("1000 rows"));
  const std::string header = hdr_header(8, 1);
  const std::string at = "byte " + std::to_string(header.size());
  CHECK_THAT(error_of(header + std::string("\2\2\0\11", 4)), Contains(at + ":") && Contains("a row of 9 pixels"));
  const std::string in_row = "byte " + std::to_string(header.size() + 4);
  CHECK_THAT(error_of(header + std::string("\2\2\0\10\211\1", 6)), Contains(in_row) && Contains("a run of 9"));
  CHECK_THAT(error_of(header + std::string("\2\2\0\10\0", 5)), Contains(in_row) && Contains("a run of 0"));
  CHECK_THAT(error_of(header + std::string("\1\1\1\3", 4)), Contains(at + ":") && Contains("after 0 of 8"));
  CHECK_THAT(error_of(header + std::string("\5\5\5\5\1\1\1\10", 8)), Contains("a run of 8"));
}

TEST_CASE("an hdr file that is cut off at any byte is refused with that byte") {
  for (const HdrCode code : {HdrCode::flat, HdrCode::old_runs, HdrCode::new_runs}) {
    const std::string whole = hdr_file(40, 6, pixels(40, 6), code);
    CHECK(error_of(whole).empty());
    std::size_t refused = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const std::string error = error_of(whole.substr(0, length));
      refused += !error.empty() && (length < 2 || error.find("byte " + std::to_string(length)) != std::string::npos);
    }
    CHECK(refused == whole.size());
  }
}
