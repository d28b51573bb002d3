#pragma once
/// Environment maps for tests, and whether directions are drawn from them as their densities say.
#include "host/image/picture_writer.h"
#include "host/lights/environment_map.h"
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace pointgi::test {

template <typename Value>
RgbImage grey_image(int width, int height, const Value& value) {
  RgbImage image;
  image.width = width;
  image.height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.rgb.insert(image.rgb.end(), 3, value(x, y));
  return image;
}

/// Values from 0 to 100, a black row, black pixels, a bright one and colours.
inline RgbImage spotted_image(int width, int height) {
  std::mt19937 random(1);
  RgbImage image = grey_image(width, height, [&](int x, int y) {
    const float value = static_cast<float>(random() % 1000) / 1000.0f;
    return y == 2 || (x + y) % 5 == 0 ? 0.0f : x == 1 && y == 1 ? 100.0f : value;
  });
  for (std::size_t i = 0; i < image.rgb.size(); i += 4)
    image.rgb[i] *= 0.25f;
  return image;
}

/// Numbers as kernels draw them: multiples of 2^-24 in [0, 1).
inline std::array<double, 4> four_numbers(std::mt19937& random) {
  std::array<double, 4> u{};
  for (double& value : u)
    value = static_cast<double>(random() >> 8) * 0x1p-24;
  return u;
}

/// Directions counted by texel against what the densities of the texels ask for.
class Histogram {
public:
  explicit Histogram(const EnvironmentMap& map) : map_(map), counts_(map.texels.size()) {}

  void count(const Vector3d& direction) {
    ++counts_[texel_towards(map_, direction)];
    ++samples_;
  }

  /// Chi-square less its mean, in its standard deviations; texels that expect less than 5 are taken together.
  double deviation() const {
    double chi = 0.0, rest_expected = 0.0, rest_counted = 0.0;
    std::size_t cells = 0;
    const auto add = [&](double expected, double counted) {
      chi += (counted - expected) * (counted - expected) / expected;
      ++cells;
    };
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      const SkyRow& row = map_.rows[i / static_cast<std::size_t>(map_.width)];
      const double expected = static_cast<double>(map_.texels[i].density) * static_cast<double>(row.solid_angle) *
                              static_cast<double>(samples_);
      const double counted = static_cast<double>(counts_[i]);
      if (expected >= 5.0) {
        add(expected, counted);
      } else {
        rest_expected += expected;
        rest_counted += counted;
      }
    }
    if (rest_expected >= 5.0) add(rest_expected, rest_counted);
    const double freedom = static_cast<double>(cells) - 1.0;
    return (chi - freedom) / std::sqrt(2.0 * freedom);
  }

private:
  const EnvironmentMap& map_;
  std::vector<std::size_t> counts_;
  std::size_t samples_ = 0;
};

/// The image as an EXR picture, which keeps its floats.
inline void write_exr(const std::string& path, const RgbImage& image) {
  const std::vector<ChannelName> channels = {{"R", false}, {"G", false}, {"B", false}};
  PictureWriter writer(path, image.width, image.height, {0, image.width, 0, image.height}, channels, {}, 0.0);
  Band band{0, image.height, image.width, std::vector<std::vector<float>>(3)};
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    band.values[i % 3].push_back(image.rgb[i]);
  writer.write(band);
  writer.finish(0.0);
}

/// The radiances as an EXR picture, a crop of one of `full_width` columns.
inline void write_exr(const std::string& path, int width, int height, int full_width,
                      const std::vector<SkyTexel>& texels) {
  const std::vector<ChannelName> channels = {{"R", false}, {"G", false}, {"B", false}};
  PictureWriter writer(path, full_width, height, {0, width, 0, height}, channels, {}, 0.0);
  Band band{0, height, width, std::vector<std::vector<float>>(3)};
  for (const SkyTexel& texel : texels)
    for (std::size_t k = 0; k < 3; ++k)
      band.values[k].push_back(texel.radiance[k]);
  writer.write(band);
  writer.finish(0.0);
}

} // namespace pointgi::test
