/// Damaged Radiance pictures: whatever the bytes, decode_hdr() returns a picture that the file can account for or
/// throws an input error that says where.
#include "host/error.h"
#include "host/image/hdr_reader.h"
#include "tests/support/hdr_bytes.h"
#include "tests/support/mutator.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr std::size_t most_pixels = 100'000;

/// Small files with everything that the reader knows, one a code of rows.
std::vector<std::string> seed_files() {
  std::vector<Rgbe> pixels;
  for (int i = 0; i < 24 * 5; ++i)
    pixels.push_back(i % 24 < 9 ? rgbe(0.5f, 1.0f, 2.0f) : Rgbe{200, static_cast<std::uint8_t>(2 * i), 7, 120});
  std::vector<std::string> seeds;
  for (const HdrCode code : {HdrCode::flat, HdrCode::old_runs, HdrCode::new_runs}) {
    std::string file =
        hdr_header(24, 5, "pfilt -x 24\nEXPOSURE=2.5\nCOLORCORR=1 1.5 2\nFORMAT=32-bit_rle_rgbe\n", "+-");
    for (int y = 0; y < 5; ++y)
      file += hdr_row({pixels.begin() + 24 * y, pixels.begin() + 24 * (y + 1)}, code);
    seeds.push_back(file);
  }
  return seeds;
}

/// Fails the test unless the outcome is one of the two that are allowed. True when it was a picture.
bool survives(const std::string& bytes) {
  try {
    const RgbImage image = decode_hdr(bytes, "sky.hdr", most_pixels);
    REQUIRE(image.width > 0);
    REQUIRE(image.height > 0);
    REQUIRE(image.pixels() <= most_pixels);
    REQUIRE(image.rgb.size() == 3 * image.pixels());
    REQUIRE(static_cast<std::size_t>(image.height) <= bytes.size() / 4);
    return true;
  } catch (const Error& error) {
    const std::string text = error.what();
    INFO(text);
    REQUIRE(error.kind() == ErrorKind::input);
    REQUIRE(text.find("sky.hdr: byte ") == 0);
    // Fit for a terminal: nothing of the file's bytes as they are.
    REQUIRE(std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    REQUIRE(text.size() < 1000);
    return false;
  }
}

} // namespace

TEST_CASE("hdr fuzz: the seeds themselves are sound") {
  for (const std::string& seed : seed_files())
    CHECK(survives(seed));
}

TEST_CASE("hdr fuzz: thousands of mutations") {
  std::uint32_t number = 0;
  for (const std::string& seed : seed_files()) {
    std::size_t pictures = 0;
    for (int i = 0; i < 5000; ++i) {
      const std::uint32_t random_seed = ++number;
      INFO("mutation " << random_seed);
      pictures += survives(Mutator(random_seed, "+X")(seed));
    }
    // Both outcomes must have been met, else the fuzz tests one half of the reader only.
    CHECK(pictures > 100);
    CHECK(pictures < 4900);
  }
}

TEST_CASE("hdr fuzz: rows of noise") {
  std::mt19937 random(11);
  std::size_t pictures = 0;
  for (int i = 0; i < 5000; ++i) {
    INFO("file " << i);
    std::string body;
    for (int k = 0; k < 200; ++k)
      body += static_cast<char>(random() % 4 == 0 ? random() % 3 : random() % 256);
    // The beginning of a row in the new code for every other file.
    pictures += survives(hdr_header(12, 3) + (i % 2 == 0 ? std::string("\2\2\0\14", 4) : std::string()) + body);
  }
  CHECK(pictures > 0);
  CHECK(pictures < 5000);
}
