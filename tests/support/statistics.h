#pragma once
/// Whether two noisy pictures may be of the same light: z-tests by their own Variance channels, of pixels and of means
/// over parts of the picture, corrected for their number (after Mitsuba 3's tests of renderings).
#include "host/image/picture_writer.h"
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pointgi::test {

namespace detail {

/// Sums in float: what they round off is no noise of the samples.
inline bool has_noise(double value, double variance) {
  return variance > 1e-10 * value * value;
}
inline bool differs_without_noise(double a, double b) {
  return std::fabs(a - b) > 2e-5 * std::fabs(a);
}

} // namespace detail

/// Mean over the pixels with noise of (a - b)^2 over the variance of their noise: 1 where it tells the noise rightly.
inline double mean_square_deviation(const Picture& a, const Picture& b, const std::string& colour) {
  const std::vector<float>&x = a.channels.at(colour), &y = b.channels.at(colour);
  const std::vector<float>&vx = a.channels.at("Variance." + colour), &vy = b.channels.at("Variance." + colour);
  double sum = 0.0;
  std::size_t noisy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = double{x[i]} - double{y[i]}, v = double{vx[i]} + double{vy[i]};
    if (!detail::has_noise(double{x[i]}, v)) continue;
    sum += off * off / v;
    ++noisy;
  }
  return noisy > 0 ? sum / static_cast<double>(noisy) : 0.0;
}

/// The hypothesis that a picture shows the same light as another, or one that differs by no more than is allowed.
struct LightTest {
  double p = 1.0;   ///< chance of so large a difference anywhere in it when the hypothesis holds; 0 where noiseless
                    ///< values differ
  std::string part; ///< where it is least likely: "G of all", "R of albedo 0.7 0 0", "B of tile 8,16", "R of pixel 3,4"
  double off = 0.0; ///< relative difference there
};

namespace detail {

/// Differences and variances, added up over a part of the picture.
struct PartSums {
  double off = 0.0, mean = 0.0, variance = 0.0;
  std::size_t unequal = 0; ///< pixels that differ without noise
};

/// Every part of a picture that is tested, by name. Pixels of one albedo are those of one material, as far as the
/// materials' albedos differ; few of them are an edge's mixture.
inline std::vector<std::pair<std::string, std::vector<std::size_t>>> parts_of(const Picture& picture, bool all_parts) {
  constexpr int tile = 8;
  constexpr std::size_t fewest = 16;
  std::map<std::array<long, 3>, std::vector<std::size_t>> of_albedo;
  std::map<std::pair<int, int>, std::vector<std::size_t>> of_tile;
  std::vector<std::size_t> all;
  const int width = picture.window.x1 - picture.window.x0;
  for (std::size_t i = 0; i < picture.channels.at("R").size(); ++i) {
    all.push_back(i);
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    of_tile[{x / tile * tile, y / tile * tile}].push_back(i);
    std::array<long, 3> albedo{};
    for (int k = 0; k < 3; ++k)
      albedo[static_cast<std::size_t>(k)] =
          std::lround(1e3 * double{picture.channels.at(std::string("Albedo.") + "RGB"[k])[i]});
    of_albedo[albedo].push_back(i);
  }
  std::vector<std::pair<std::string, std::vector<std::size_t>>> parts{{"all", all}};
  for (const auto& [albedo, pixels] : of_albedo) {
    if (pixels.size() < fewest) continue;
    std::string name = "albedo";
    for (const long k : albedo)
      name += " " + std::to_string(1e-3 * static_cast<double>(k)).substr(0, 5);
    parts.emplace_back(name, pixels);
  }
  if (!all_parts) return parts;
  for (const auto& [corner, pixels] : of_tile)
    parts.emplace_back("tile " + std::to_string(corner.first) + "," + std::to_string(corner.second), pixels);
  for (const std::size_t i : all)
    parts.emplace_back("pixel " + std::to_string(i % static_cast<std::size_t>(width)) + "," +
                           std::to_string(i / static_cast<std::size_t>(width)),
                       std::vector<std::size_t>{i});
  return parts;
}

} // namespace detail

/// Tests the mean of the picture and of each material's pixels, and, where nothing is `allowed`, of tiles of 8 x 8
/// pixels and of each pixel, in R, G and B: a bias of 1 % is lost in a pixel's noise and plain in a material's mean. By
/// Sidak's correction `p` is that of all tests together: the hypothesis is rejected where it is below a significance,
/// and rightly held pictures are rejected that often. `allowed`: what the means of `a` may be off beside noise,
/// relative to `truth`, for a method that is known to be off by so much. Both need 64 samples a pixel and more for the
/// sums to be near normal; parts are those of `truth`.
inline LightTest test_of_light(const Picture& a, const Picture& truth, double allowed = 0.0) {
  const auto parts = detail::parts_of(truth, allowed == 0.0);
  const double tests = 3.0 * static_cast<double>(parts.size());
  LightTest result;
  for (const char* colour : {"R", "G", "B"}) {
    const std::vector<float>&x = a.channels.at(colour), &y = truth.channels.at(colour);
    const std::vector<float>&vx = a.channels.at(std::string("Variance.") + colour),
          &vy = truth.channels.at(std::string("Variance.") + colour);
    for (const auto& [name, pixels] : parts) {
      detail::PartSums sums;
      for (const std::size_t i : pixels) {
        const double v = double{vx[i]} + double{vy[i]};
        sums.off += double{x[i]} - double{y[i]};
        sums.mean += double{y[i]};
        sums.unequal +=
            !detail::has_noise(double{x[i]}, v) && detail::differs_without_noise(double{x[i]}, double{y[i]});
        sums.variance += v;
      }
      const double beyond = std::fabs(sums.off) - allowed * std::fabs(sums.mean);
      if (!(beyond > 0.0)) continue;
      double p = 0.0;
      if (detail::has_noise(sums.mean, sums.variance)) {
        const double one = std::erfc(beyond / std::sqrt(2.0 * sums.variance));
        p = -std::expm1(tests * std::log1p(-std::fmin(one, 1.0 - 1e-16))); // 1 - (1 - one)^tests
      } else if (allowed == 0.0 && sums.unequal == 0) {
        continue;
      }
      if (p < result.p) result = {p, std::string(colour) + " of " + name, sums.off / sums.mean};
    }
  }
  return result;
}

/// Below it a test of light fails. Of a thousand right pictures one is rejected; seeds are fixed, so a test that passes
/// does so again.
constexpr double significance = 1e-3;

} // namespace pointgi::test
