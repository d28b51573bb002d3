/// Which light of a picture is denoised, with what beside it, and what the picture is afterwards.
#include "host/denoise/denoise_picture.h"
#include "host/error.h"
#include "tests/support/fake_oidn.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr int width = 6, height = 4, pixels = width * height;

struct Rows {
  std::vector<ChannelName> channels;
  Band band{0, height, width, {}};

  std::vector<float>& at(const std::string& name) {
    for (std::size_t c = 0; c < channels.size(); ++c)
      if (channels[c].name == name) return band.values[c];
    FAIL("no channel " << name);
    return band.values[0];
  }

  void add(const std::string& name, const std::function<float(int)>& value) {
    channels.push_back({name, false});
    band.values.emplace_back();
    for (int i = 0; i < pixels; ++i)
      band.values.back().push_back(value(i));
  }
};

/// Each light has its own values, each three colours.
Rows picture(bool all_lights) {
  Rows rows;
  for (const char* name : {"R", "G", "B"})
    rows.add(name, [](int i) { return 40.0f + static_cast<float>(i); });
  float step = 1.0f;
  for (const char* light : {"Direct.", "Diffuse.", "Specular.", "Caustic."})
    for (const char* colour : {"R", "G", "B"}) {
      step += 1.0f;
      if (all_lights || light == std::string("Direct."))
        rows.add(std::string(light) + colour, [&](int i) { return 8.0f + step * static_cast<float>(i); });
    }
  for (const char* name : {"Denoise.Albedo.R", "Denoise.Albedo.G", "Denoise.Albedo.B"})
    rows.add(name, [](int i) { return static_cast<float>(i % 4) * 0.25f; });
  for (const char* name : {"Denoise.N.X", "Denoise.N.Y", "Denoise.N.Z"})
    rows.add(name, [](int i) { return static_cast<float>(i % 3) * 0.5f - 0.5f; });
  for (const char* name : {"Denoise.Emission.R", "Denoise.Emission.G", "Denoise.Emission.B"})
    rows.add(name, [](int i) { return i == 7 ? 5.0f : 0.0f; });
  for (const ChannelName& name : noisy_channels())
    rows.add(name.name, [](int) { return 0.0f; });
  return rows;
}

void denoise(Rows& rows) {
  const Denoiser denoiser(1);
  denoise_picture(denoiser, rows.channels, rows.band, [](double) {});
}

} // namespace

TEST_CASE("each light is denoised by itself, but for the share of emission, by denoised albedo and normal, and R G B "
          "are the sum") {
  const FakeOidn fake;
  const bool all_lights = GENERATE(false, true);
  Rows rows = picture(all_lights);
  const Rows before = rows;
  denoise(rows);
  Rows old = before;
  const std::vector<std::string> lights = all_lights
                                              ? std::vector<std::string>{"Direct.", "Diffuse.", "Specular.", "Caustic."}
                                              : std::vector<std::string>{"Direct."};
  for (int k = 0; k < 3; ++k) {
    const char colour = "RGB"[k];
    for (std::size_t i = 0; i < pixels; ++i) {
      CAPTURE(k, i);
      // The stand-in halves the guides when they are alone, and brightens light by both.
      const float guided = 1.0f + 0.5f * old.at(std::string("Denoise.Albedo.") + colour)[i] +
                           0.5f * old.at(std::string("Denoise.N.") + "XYZ"[k])[i];
      double sum = 0.0;
      for (const std::string& light : lights) {
        float emission = 0.0f, all = 0.0f;
        for (const char c : {'R', 'G', 'B'}) {
          emission += light == "Direct." ? old.at(std::string("Denoise.Emission.") + c)[i] : 0.0f;
          all += old.at(light + c)[i];
        }
        const float factor = emission / all + (1.0f - emission / all) * guided;
        CHECK(rows.at(light + colour)[i] == Approx(old.at(light + colour)[i] * factor).epsilon(1e-6));
        sum += double{rows.at(light + colour)[i]};
      }
      CHECK(rows.at(std::string(1, colour))[i] == static_cast<float>(sum));
    }
    CHECK(rows.at(std::string("Noisy.") + colour) == old.at(std::string(1, colour)));
    CHECK(rows.at(std::string("Denoise.Albedo.") + colour) == old.at(std::string("Denoise.Albedo.") + colour));
  }
}

TEST_CASE("where all of the direct light is emission, it stays as it was rendered") {
  const FakeOidn fake;
  Rows rows = picture(false);
  for (const char colour : {'R', 'G', 'B'})
    rows.at(std::string("Denoise.Emission.") + colour) = rows.at(std::string("Direct.") + colour);
  Rows before = rows;
  denoise(rows);
  for (const char* name : {"Direct.R", "Direct.G", "Direct.B"})
    CHECK(rows.at(name) == before.at(name));
}

TEST_CASE("progress tells the filters: two for the guides, one for each light") {
  const FakeOidn fake;
  Rows rows = picture(true);
  const Denoiser denoiser(1);
  std::vector<double> shares;
  denoise_picture(denoiser, rows.channels, rows.band, [&](double share) { shares.push_back(share); });
  REQUIRE(shares.size() == 6);
  CHECK(shares.front() == Approx(1.0 / 6.0));
  CHECK(shares.back() == 1.0);
}

TEST_CASE("light of any size is denoised as light of size 1 is") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  for (const float factor : {0x1p-100f, 1.0f, 0x1p100f}) {
    CAPTURE(factor);
    Rows rows = picture(false), plain = rows;
    for (const char* name :
         {"Direct.R", "Direct.G", "Direct.B", "Denoise.Emission.R", "Denoise.Emission.G", "Denoise.Emission.B"})
      for (float& value : rows.at(name))
        value *= factor;
    denoise(rows);
    denoise(plain);
    for (std::size_t i = 0; i < pixels; ++i)
      CHECK(rows.at("R")[i] == factor * plain.at("R")[i]);
  }
}

TEST_CASE("black light stays black and is not handed to the filter") {
  const FakeOidn fake;
  const TemporaryFolder folder;
  Rows rows = picture(true);
  for (const char* name : {"Diffuse.R", "Diffuse.G", "Diffuse.B"})
    rows.at(name).assign(pixels, 0.0f);
  const Variable log("FAKE_OIDN_LOG", folder.file("log").c_str());
  denoise(rows);
  CHECK(rows.at("Diffuse.G") == std::vector<float>(pixels, 0.0f));
  const std::string lines = contents(folder.file("log"));
  CHECK(std::count(lines.begin(), lines.end(), '\n') == 5);
}

TEST_CASE("whatever a picture holds, it is finite once it is denoised") {
  const char* const fault = GENERATE(static_cast<const char*>(nullptr), "nan");
  const FakeOidn fake(fault);
  Rows rows = picture(true);
  const float inf = std::numeric_limits<float>::infinity();
  rows.at("Direct.R")[1] = NAN;
  rows.at("Direct.G")[2] = inf;
  rows.at("Diffuse.B")[3] = -inf;
  rows.at("Denoise.N.X")[4] = NAN;
  rows.at("Denoise.Albedo.G")[5] = inf;
  rows.at("Denoise.Emission.B")[6] = NAN;
  for (float& value : rows.at("Specular.R"))
    value = NAN;
  for (const char* name : {"Specular.G", "Specular.B"})
    rows.at(name).assign(pixels, 0.0f);
  denoise(rows);
  for (const char* name : {"R", "Direct.R", "Direct.B", "Diffuse.B", "Specular.R", "Caustic.G"})
    for (const float value : rows.at(name)) {
      CAPTURE(name);
      CHECK(std::isfinite(value));
      CHECK(value >= 0.0f);
    }
}

TEST_CASE("where the library fails, the picture is as it was rendered") {
  const FakeOidn fake("late");
  Rows rows = picture(true);
  const Rows before = rows;
  CHECK_THROWS_AS(denoise(rows), Error);
  Rows old = before;
  for (const char* name : {"R", "B", "Direct.R", "Caustic.G", "Denoise.Albedo.R"})
    CHECK(rows.at(name) == old.at(name));
  CHECK(rows.at("Noisy.R") == old.at("R"));
}

TEST_CASE("no rows and one pixel are pictures, too") {
  const FakeOidn fake;
  Rows rows = picture(true);
  rows.band.rows = 0;
  for (std::vector<float>& values : rows.band.values)
    values.clear();
  CHECK_NOTHROW(denoise(rows));
  rows = picture(true);
  rows.band.rows = rows.band.width = 1;
  for (std::vector<float>& values : rows.band.values)
    values.resize(1);
  denoise(rows);
  CHECK(rows.at("Direct.R")[0] == 8.0f * 0.75f);
}
