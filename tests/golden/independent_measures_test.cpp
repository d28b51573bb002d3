/// The figures of `pointgi compare` against independent programs, where these are installed.
#include "host/image/exr_writer.h"
#include "tests/support/run_program.h"
#include "tests/support/run_python.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <sstream>

using namespace pointgi;
using namespace pointgi::test;

namespace {

using Pixel = std::function<double(int x, int y, int channel)>;

struct Frame {
  PixelWindow window;
  int full_width, full_height;
};

Frame whole(int width, int height) {
  return {{0, width, 0, height}, width, height};
}

/// Pixels count from the corner of the full picture; channel 3 is A.
std::string write_picture(const std::string& path, const Frame& frame, const Pixel& value) {
  std::vector<ChannelName> channels;
  Band rows{frame.window.y0, frame.window.y1 - frame.window.y0, frame.window.x1 - frame.window.x0, {}};
  for (const char* name : {"R", "G", "B", "A"}) {
    channels.push_back({name, false});
    std::vector<float>& values = rows.values.emplace_back();
    for (int y = frame.window.y0; y < frame.window.y1; ++y)
      for (int x = frame.window.x0; x < frame.window.x1; ++x)
        values.push_back(static_cast<float>(value(x, y, static_cast<int>(rows.values.size()) - 1)));
  }
  ExrWriter writer(path, frame.full_width, frame.full_height, frame.window, channels, {});
  writer.write(rows);
  writer.close(0.0);
  writer.commit();
  return path;
}

double waves(int x, int y, int channel) {
  return channel == 3 ? 1.0 : (1 + channel) * (0.5 + 0.25 * std::sin(0.7 * x) + 0.125 * std::cos(0.4 * y));
}

double edge(int x, int, int channel) {
  return channel == 3 ? 1.0 : x < 30 ? 0.25 : 1.0 + 0.5 * channel;
}

/// 1e-6 to 1e6, each power as often as another.
double powers(int x, int y, int channel) {
  return std::pow(10.0, -6.0 + 12.0 * ((x * 37 + y * 101 + channel * 53) % 240) / 239.0);
}

/// Pixels are asked for once, in order: the numbers are the same whenever this is made anew with the seed.
Pixel with_noise(const Pixel& value, double sigma, unsigned seed) {
  auto engine = std::make_shared<std::mt19937>(seed);
  auto normal = std::make_shared<std::normal_distribution<double>>();
  return [=](int x, int y, int channel) { return value(x, y, channel) * (1.0 + sigma * (*normal)(*engine)); };
}

struct Pair {
  std::string name, a, b;
};

/// The first four are for programs that know neither windows, holes nor small pictures.
std::vector<Pair> write_pairs(const TemporaryFolder& folder) {
  std::vector<Pair> pairs;
  const auto add = [&](const std::string& name, const Frame& frame_a, const Pixel& a, const Frame& frame_b,
                       const Pixel& b) {
    pairs.push_back({name, write_picture(folder.file(name + "-a.exr"), frame_a, a),
                     write_picture(folder.file(name + "-b.exr"), frame_b, b)});
  };
  const Frame usual = whole(64, 48);
  add("noise", usual, with_noise(waves, 0.2, 1), usual, waves);
  add(
      "offset", usual, [](int x, int y, int c) { return waves(x, y, c) + 0.01; }, usual, waves);
  add(
      "edge", usual, [](int x, int y, int c) { return edge(x - 3, y, c); }, usual, edge);
  add("powers", usual, with_noise(powers, 0.1, 2), usual, powers);

  add("equal", usual, waves, usual, waves);
  add("black", usual, waves, usual, [](int, int, int) { return 0.0; });
  add("small", whole(9, 7), with_noise(waves, 0.2, 3), whole(9, 7), waves);
  // 99 % of their values are a whole number of them.
  add("hundreds", whole(20, 10), with_noise(waves, 0.2, 7), whole(20, 10), waves);
  add("narrow", whole(9, 40), with_noise(waves, 0.2, 4), whole(9, 40), waves);
  add("windows", {{5, 60, 0, 40}, 64, 48}, with_noise(waves, 0.2, 5), {{0, 50, 8, 48}, 64, 48}, waves);
  const auto holes = [](int x, int y, int c) {
    return x == 20 && y == 9 && c == 1 ? std::nan("") : x == 40 && c == 2 ? INFINITY : waves(x, y, c);
  };
  add("holes", usual, holes, usual, with_noise(waves, 0.2, 6));
  // Coverage is compared by nobody.
  add(
      "coverage", usual, [](int x, int y, int c) { return c == 3 && x < 20 ? 0.0 : waves(x, y, c) * 1.1; }, usual,
      waves);
  return pairs;
}

nlohmann::json figures_of(const Pair& pair) {
  const Run run = run_program("compare " + pair.a + " " + pair.b + " --json");
  INFO(run.err);
  REQUIRE(run.code == 0);
  return nlohmann::json::parse(run.out);
}

} // namespace

TEST_CASE("compare finds what scikit-image, scipy and numpy find") {
  const TemporaryFolder folder;
  const std::vector<Pair> pairs = write_pairs(folder);
  std::string files;
  for (const Pair& pair : pairs)
    files += pair.a + " " + pair.b + " ";
  const auto printed = printed_by_python("golden/independent_measures.py", files, "scikit-image or OpenEXR");
  if (!printed) return;
  std::istringstream lines(*printed);
  std::string line;
  for (const Pair& pair : pairs) {
    REQUIRE(std::getline(lines, line));
    const nlohmann::json theirs = nlohmann::json::parse(line), ours = figures_of(pair);
    INFO(pair.name);
    for (const char* key : {"area", "pixels", "not_finite"})
      CHECK(ours.at(key) == theirs.at(key));
    for (const char* key : {"eps", "white"})
      CHECK(ours.at(key).get<double>() == Approx(theirs.at(key).get<double>()).epsilon(1e-6));
    for (const char* values : {"all", "R", "G", "B"})
      for (const auto& [figure, value] : theirs.at(values).items()) {
        INFO(values << " " << figure);
        const nlohmann::json& own = ours.at(values).at(figure);
        if (value.is_null()) {
          CHECK(own.is_null());
          continue;
        }
        // Radiance has no scale of its own, so its figures agree relative to themselves. SSIM and bias are differences
        // of numbers near 1. Ours sees pictures through a curve in float.
        const bool scaleless = figure == "ssim" || figure == "bias";
        const auto near = Approx(value.get<double>()).epsilon(scaleless ? 0.0 : 1e-6).margin(scaleless ? 1e-6 : 0.0);
        CHECK(own.get<double>() == near);
      }
  }
}

TEST_CASE("compare finds what oiiotool finds") {
  if (std::system("command -v oiiotool >/dev/null 2>&1") != 0) {
    WARN("skipped: no oiiotool is installed");
    something_skipped = true;
    return;
  }
  const TemporaryFolder folder;
  std::vector<Pair> pairs = write_pairs(folder);
  pairs.resize(4);
  for (const Pair& pair : pairs) {
    INFO(pair.name);
    const std::string out = folder.file("out");
    // It ends with an error where pictures differ.
    const int ignored =
        std::system(("oiiotool " + pair.a + " --ch R,G,B " + pair.b + " --ch R,G,B --diff >" + out).c_str());
    (void)ignored;
    const std::string text = contents(out);
    INFO(text);
    std::smatch found;
    REQUIRE(std::regex_search(text, found, std::regex("RMS error = ([-+.0-9e]+)")));
    // Its text has six digits.
    CHECK(std::sqrt(figures_of(pair).at("all").at("mse").get<double>()) == Approx(std::stod(found[1])).epsilon(1e-5));
  }
}
