/// The largest photon map and the largest picture that a scene may ask for: minutes each, run by hand
/// (tests_golden "[vast]").
#include "tests/support/render.h"
#include "tests/support/run_program.h"
#include "tests/support/stats_file.h"
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Channel R of one row.
std::vector<float> row_of(const std::string& path, int row, int width) {
  std::vector<float> values(static_cast<std::size_t>(width));
  Imf::InputFile file(path.c_str());
  Imf::FrameBuffer buffer;
  buffer.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), 0));
  file.setFrameBuffer(buffer);
  file.readPixels(row);
  return values;
}

} // namespace

TEST_CASE("a hundred million photons: the share of each fate is that of a million, and 1 GiB of them is kept",
          "[.][vast]") {
  const TemporaryFolder folder;
  const std::string stats = folder.file("stats.json"), scene = folder.write("scene.toml", mirror_scene());
  const auto sent = [&](std::uint64_t photons) {
    const Run run = run_program("render " + scene + " --quiet -o " + folder.file("x.exr") + " --stats " + stats +
                                " --set caustics.photons=" + std::to_string(photons));
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    return json_of(stats);
  };
  constexpr std::uint64_t few = 1'000'000, many = 100'000'000;
  const nlohmann::json of_few = sent(few)["photons"], run = sent(many), of_many = run["photons"];
  for (const char* fate : {"aimed", "emitted", "stored", "escaped", "absorbed", "cut"}) {
    CAPTURE(fate);
    // 400,000 of a million escape, with a deviation of 500.
    CHECK(std::abs(of_many[fate].get<double>() / many - of_few[fate].get<double>() / few) < 0.002);
  }
  const auto count = [&](const char* name) { return of_many[name].get<std::uint64_t>(); };
  CHECK(count("emitted") == count("stored") + count("absorbed") + count("escaped") + count("cut"));
  CHECK(count("kept") < count("stored"));
  CHECK(count("kept") > (std::uint64_t{1} << 30) / 32 / 2); // one of 2, 4, ... is kept
  CHECK(count("kept") <= (std::uint64_t{1} << 30) / 32);
  // The map, its tree and what builds them; the program and its driver.
  CHECK(run["memory"]["host_peak_bytes"].get<double>() < 4.0 * (1u << 30));
}

TEST_CASE("a picture of 16384 x 16384 is that of a small one, and takes little memory", "[.][vast]") {
  constexpr int side = 16384, small_side = 64;
  const TemporaryFolder folder;
  // A sphere around all, so that no row is black.
  const std::string scene =
      folder.write("scene.toml", std::string(small_scene()) +
                                     "[[shape]]\ntype = \"sphere\"\ncentre = [0.0, 0.0, 0.0]\nradius = 5.0\n"
                                     "spacing = 0.3\ninward = true\nmaterial = \"grey\"\n");
  const std::string stats = folder.file("stats.json");
  const auto render = [&](const std::string& name, int size, const std::string& options) {
    const std::string pixels = std::to_string(size);
    const Run run = run_program("render " + scene + " --quiet --set radiosity.method=none -o " + folder.file(name) +
                                " --size " + pixels + "x" + pixels + " " + options);
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
  };
  render("small.exr", small_side, "--spp 1024");
  render("vast.exr", side, "--spp 1 --stats " + stats);
  CHECK(json_of(stats)["memory"]["host_peak_bytes"].get<double>() < 1.0 * (1u << 30));
  // Means over the pixels that a small one covers: of the rows there a few, spread evenly.
  constexpr int share = side / small_side, rows = 16;
  for (const int at : {0, 15, 31, 32, 48, 63}) {
    const auto small = row_of(folder.file("small.exr"), at, small_side);
    std::vector<double> sums(small_side);
    for (int k = 0; k < rows; ++k) {
      const auto row = row_of(folder.file("vast.exr"), at * share + k * share / rows + share / rows / 2, side);
      for (int x = 0; x < side; ++x)
        sums[static_cast<std::size_t>(x / share)] += static_cast<double>(row[static_cast<std::size_t>(x)]);
    }
    double worst = 0.0, brightest = 0.0;
    for (int x = 0; x < small_side; ++x) {
      const double value = small[static_cast<std::size_t>(x)];
      worst = std::max(worst, std::abs(sums[static_cast<std::size_t>(x)] / (rows * share) - value));
      brightest = std::max(brightest, value);
    }
    CAPTURE(at);
    // Pixels at the ball's rim, of which 16 rows of 256 tell a part only, are a few percent off.
    CHECK(brightest > 0.0);
    CHECK(worst < 0.05 * brightest);
  }
}
