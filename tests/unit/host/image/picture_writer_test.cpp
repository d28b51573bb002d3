#include "host/error.h"
#include "host/image/picture_writer.h"
#include "tests/unit/host/image/picture_fixture.h"
#include <ImfChromaticities.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfThreading.h>
#include <catch2/catch.hpp>
#include <limits>
#include <optional>

using namespace pointgi;
using namespace pointgi::test::picture;

namespace {

PictureAttributes some_attributes() {
  PictureAttributes attributes;
  attributes.text = {{"software", "pointgi test"}, {"pointgi/device", "a device"}, {"pointgi/quality", ""}};
  attributes.number = {{"samplesPerPixel", 32.0}, {"pointgi/x", -0.5}};
  for (std::size_t i = 0; i < 16; ++i) {
    attributes.world_to_camera[i] = static_cast<float>(i) + 0.25f;
    attributes.world_to_ndc[i] = -static_cast<float>(i);
  }
  return attributes;
}

/// Both are zero, or their bits are the same.
bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

} // namespace

TEST_CASE("every channel kind comes back bit by bit, whatever the bands", "[picture]") {
  const int width = 37, height = 41; // no multiple of the 16 rows that ZIP packs together
  const auto channels = all_channels();
  const int band_rows = GENERATE(1, 7, 16, 41);
  const Folder folder;
  Band whole = random_band(channels, 0, height, width, 1);
  for (const std::uint32_t id : {0u, 1u, (1u << 24) + 1, 0x7fffffffu, 0x80000000u, 0xffffffffu})
    std::memcpy(&whole.values.back()[id % 97], &id, sizeof id);
  whole.values[0][5] = std::numeric_limits<float>::infinity();
  whole.values[1][6] = std::numeric_limits<float>::quiet_NaN();
  whole.values[2][7] = std::numeric_limits<float>::denorm_min();

  PictureWriter writer(folder.file("a.exr"), width, height, {0, width, 0, height}, channels, some_attributes(), 0.0);
  for (int row = 0; row < height; row += band_rows) {
    Band band{row, std::min(band_rows, height - row), width, {}};
    for (const auto& values : whole.values)
      band.values.emplace_back(values.begin() + row * width, values.begin() + (row + band.rows) * width);
    writer.write(band);
  }
  writer.finish(12.5);

  const Picture picture = read_exr(folder.file("a.exr"));
  CHECK(picture.width == width);
  CHECK(picture.height == height);
  REQUIRE(picture.channels.size() == channels.size());
  for (std::size_t c = 0; c + 1 < channels.size(); ++c) {
    INFO(channels[c].name);
    CHECK(same_bits(picture.channels.at(channels[c].name), whole.values[c]));
  }
  REQUIRE(picture.uints.size() == 1);
  const auto& ids = picture.uints.at("PointId");
  REQUIRE(ids.size() == whole.values.back().size());
  CHECK(std::memcmp(ids.data(), whole.values.back().data(), ids.size() * sizeof(float)) == 0);
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (picture.channels.at("PointId")[i] != static_cast<float>(ids[i])) FAIL("id " << i << " not converted by value");
  CHECK(folder.names() == std::vector<std::string>{"a.exr", "a.png"});
}

TEST_CASE("attributes come back, also the one that is known last", "[picture]") {
  const Folder folder;
  PictureWriter writer(folder.file("a.exr"), 3, 2, {0, 3, 0, 2}, rgb_channels(), some_attributes(), 0.0);
  CHECK(writer.exr_path() == folder.file("a.exr"));
  CHECK(writer.png_path() == folder.file("a.png"));
  writer.write(random_band(rgb_channels(), 0, 2, 3, 2));
  writer.finish(1234.5);

  const PictureAttributes read = read_exr(folder.file("a.exr")).attributes;
  CHECK(read.text.at("software") == "pointgi test");
  CHECK(read.text.at("pointgi/device") == "a device");
  CHECK(read.text.at("pointgi/quality").empty());
  CHECK(read.number.at("samplesPerPixel") == 32.0);
  CHECK(read.number.at("pointgi/x") == -0.5);
  CHECK(read.number.at("renderTimeSeconds") == 1234.5);
  CHECK(read.number.at("pixelAspectRatio") == 1.0);
  CHECK(read.world_to_camera == some_attributes().world_to_camera);
  CHECK(read.world_to_ndc == some_attributes().world_to_ndc);

  Imf::InputFile file(folder.file("a.exr").c_str());
  CHECK(file.header().compression() == Imf::ZIP_COMPRESSION);
  REQUIRE(Imf::hasChromaticities(file.header()));
  // Rec. 709: the three primaries and D65.
  const Imf::Chromaticities& primaries = Imf::chromaticities(file.header());
  CHECK(primaries.red == Imath::V2f(0.64f, 0.33f));
  CHECK(primaries.green == Imath::V2f(0.30f, 0.60f));
  CHECK(primaries.blue == Imath::V2f(0.15f, 0.06f));
  CHECK(primaries.white == Imath::V2f(0.3127f, 0.3290f));
}

TEST_CASE("a pixel window lies where it belongs in the larger image", "[picture]") {
  const Folder folder;
  const PixelWindow window{100, 117, 40, 60};
  PictureWriter writer(folder.file("a.exr"), 640, 480, window, all_channels(), {}, 0.0);
  const Band top = random_band(all_channels(), 40, 13, 17, 3), bottom = random_band(all_channels(), 53, 7, 17, 4);
  writer.write(top);
  writer.write(bottom);
  writer.finish(0.0);

  const Picture picture = read_exr(folder.file("a.exr"));
  CHECK(picture.full_width == 640);
  CHECK(picture.full_height == 480);
  CHECK(picture.width == 17);
  CHECK(picture.height == 20);
  CHECK(picture.window.x0 == 100);
  CHECK(picture.window.x1 == 117);
  CHECK(picture.window.y0 == 40);
  CHECK(picture.window.y1 == 60);
  std::vector<float> red = top.values[0];
  red.insert(red.end(), bottom.values[0].begin(), bottom.values[0].end());
  CHECK(same_bits(picture.channels.at("R"), red));
}

TEST_CASE("a PNG whose exposure is chosen is that of the same number of stops", "[picture]") {
  const Folder folder;
  const int width = 21, height = 35, bands = GENERATE(1, 16, 35);
  const std::vector<ChannelName> channels{{"R", false}, {"G", false}, {"B", false}, {"A", false}};
  Band whole{0, height, width, std::vector<std::vector<float>>(4)};
  for (int i = 0; i < width * height; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      whole.values[c].push_back(1e-3f * static_cast<float>(1 + i + 100 * static_cast<int>(c)));
    whole.values[3].push_back(1.0f);
  }
  const PixelWindow window{3, 3 + width, 4, 4 + height};
  const auto write = [&](const std::string& name, std::optional<double> stops) {
    PictureWriter writer(folder.file(name), 40, 50, window, channels, {}, stops);
    for (int row = 0; row < height; row += bands) {
      Band band{window.y0 + row, std::min(bands, height - row), width, {}};
      for (const auto& values : whole.values)
        band.values.emplace_back(values.begin() + row * width, values.begin() + (row + band.rows) * width);
      writer.write(band);
    }
    writer.finish(1.0);
    return writer.png_light();
  };
  const PngLight chosen = write("chosen.exr", std::nullopt);
  CHECK(chosen.exposure != 0.0);
  CHECK((chosen.mean > 0.25 && chosen.mean < 0.7));
  write("given.exr", chosen.exposure);
  CHECK(bytes_of(folder.file("chosen.png")) == bytes_of(folder.file("given.png")));
  const Picture picture = read_exr(folder.file("chosen.exr"));
  CHECK(picture.attributes.number.at("pointgi/exposure") == Approx(chosen.exposure));
  CHECK(picture.attributes.number.at("renderTimeSeconds") == 1.0);
  CHECK(read_exr(folder.file("given.exr")).attributes.number.count("pointgi/exposure") == 0);
  CHECK(picture.channels.at("R") == whole.values[0]); // linear light stays as it is
}

TEST_CASE("an interrupted picture is filled with zeros", "[picture]") {
  const Folder folder;
  const int written = GENERATE(0, 5, 16);
  PictureWriter writer(folder.file("a.exr"), 9, 50, {0, 9, 0, 50}, all_channels(), {}, 0.0);
  const Band band = random_band(all_channels(), 0, written, 9, 5);
  writer.write(band);
  writer.finish(0.0);

  const Picture picture = read_exr(folder.file("a.exr"));
  for (const ChannelName& channel : all_channels()) {
    const std::vector<float>& values = picture.channels.at(channel.name);
    REQUIRE(values.size() == 9 * 50);
    CHECK(std::all_of(values.begin() + written * 9, values.end(), [](float v) { return v == 0.0f; }));
  }
  CHECK(std::equal(band.values[0].begin(), band.values[0].end(), picture.channels.at("R").begin()));
}

TEST_CASE("extreme shapes of pictures can be written", "[picture]") {
  const Folder folder;
  const auto [width, height] =
      GENERATE(std::pair{1, 1}, std::pair{1, 16384}, std::pair{16384, 1}, std::pair{16384, 33});
  const auto channels = all_channels();
  PictureWriter writer(folder.file("a.exr"), width, height, {0, width, 0, height}, channels, {}, 0.0);
  Band band{0, height, width, {}};
  band.values.assign(channels.size(), std::vector<float>(static_cast<std::size_t>(width * height), 0.5f));
  writer.write(band);
  writer.finish(0.0);
  const Picture picture = read_exr(folder.file("a.exr"));
  CHECK(picture.width == width);
  CHECK(picture.height == height);
  CHECK(picture.channels.at("Variance.B") == band.values[0]);
}

TEST_CASE("bands that do not fit are refused", "[picture]") {
  const Folder folder;
  const auto channels = rgb_channels();
  PictureWriter writer(folder.file("a.exr"), 8, 6, {0, 8, 2, 6}, channels, {}, 0.0);
  writer.write(random_band(channels, 2, 3, 8, 6));

  Band short_channel = random_band(channels, 5, 1, 8, 6), lacks_channel = short_channel;
  short_channel.values[1].pop_back();
  lacks_channel.values.pop_back();
  for (const Band& wrong : {random_band(channels, 5, 2, 8, 6), // beyond the window
                            random_band(channels, 4, 1, 8, 6), // a row again
                            random_band(channels, 6, 1, 8, 6), // a row left out
                            random_band(channels, 5, 1, 7, 6), // too narrow
                            Band{5, -1, 8, {{}, {}, {}}}, short_channel, lacks_channel}) {
    try {
      writer.write(wrong);
      FAIL("accepted " << wrong.rows << " rows from " << wrong.first_row);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::internal);
      CHECK_THAT(error.what(), Catch::Contains("does not fit"));
    }
  }
  // The writer is none the worse for it.
  writer.write(random_band(channels, 5, 1, 8, 6));
  CHECK_THROWS_AS(writer.write(random_band(channels, 6, 1, 8, 6)), Error);
  writer.finish(0.0);
  CHECK_THROWS_AS(writer.finish(0.0), Error);
  CHECK(read_exr(folder.file("a.exr")).height == 4);
}

TEST_CASE("channels and windows that make no picture are refused", "[picture]") {
  const Folder folder;
  const std::string path = folder.file("a.exr");
  auto kind_of = [&](PixelWindow window, const std::vector<ChannelName>& channels) -> std::optional<ErrorKind> {
    try {
      PictureWriter writer(path, 8, 6, window, channels, {}, 0.0);
    } catch (const Error& error) {
      return error.kind();
    }
    return std::nullopt;
  };
  for (const PixelWindow window : {PixelWindow{0, 9, 0, 6}, PixelWindow{0, 8, 0, 7}, PixelWindow{-1, 8, 0, 6},
                                   PixelWindow{0, 8, -1, 6}, PixelWindow{4, 4, 0, 6}, PixelWindow{0, 8, 5, 3}})
    CHECK(kind_of(window, rgb_channels()) == ErrorKind::usage);
  const PixelWindow all{0, 8, 0, 6};
  CHECK(kind_of(all, {{"R", false}, {"G", false}}) == ErrorKind::internal);
  CHECK(kind_of(all, {{"R", false}, {"G", false}, {"B", false}, {"G", false}}) == ErrorKind::internal);
  CHECK(kind_of(all, {{"R", false}, {"G", false}, {"B", true}}) == ErrorKind::internal);
  CHECK(folder.names().empty());
}

TEST_CASE("the bytes of a picture do not depend on the number of threads", "[picture]") {
  const Folder folder;
  const int before = Imf::globalThreadCount();
  for (const int threads : {0, 3}) {
    Imf::setGlobalThreadCount(threads);
    PictureWriter writer(folder.file(std::to_string(threads) + ".exr"), 50, 200, {0, 50, 0, 200}, all_channels(), {},
                         0.0);
    writer.write(random_band(all_channels(), 0, 200, 50, 7));
    writer.finish(1.0);
  }
  Imf::setGlobalThreadCount(before);
  const bool same = bytes_of(folder.file("0.exr")) == bytes_of(folder.file("3.exr"));
  CHECK(same);
}
