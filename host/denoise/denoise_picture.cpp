#include "host/denoise/denoise_picture.h"
#include "host/error.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace pointgi {

namespace {

using Places = std::array<std::size_t, 3>;

constexpr float most = 3.402823466e38f;

/// Of the channels `prefix` + R, G and B, or X, Y and Z; absent where one is.
std::optional<Places> places_of(const std::vector<ChannelName>& channels, const std::string& prefix,
                                const char* letters = "RGB") {
  Places found{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string name = prefix + letters[k];
    const auto at = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
    if (at == channels.end()) return std::nullopt;
    found[k] = static_cast<std::size_t>(at - channels.begin());
  }
  return found;
}

Places required(const std::vector<ChannelName>& channels, const std::string& prefix, const char* letters = "RGB") {
  const std::optional<Places> found = places_of(channels, prefix, letters);
  if (!found) throw Error(ErrorKind::internal, "denoising: the picture has no channel " + prefix + letters[0]);
  return *found;
}

/// Three planes as the filter takes them, within bounds; what is no number becomes 0.
std::vector<float> interleaved(const Band& rows, const Places& places, float low, float high) {
  const std::size_t pixels = rows.values[places[0]].size();
  std::vector<float> all(3 * pixels);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < pixels; ++i) {
      const float value = rows.values[places[k]][i];
      all[3 * i + k] = std::isnan(value) ? 0.0f : std::clamp(value, low, high);
    }
  return all;
}

/// The power of two that makes the mean of an image about 1, as the filter expects light of that size; absent of a
/// black image.
std::optional<int> exponent_of(const std::vector<float>& image) {
  double sum = 0.0;
  for (const float value : image)
    sum += double{value};
  if (!(sum > 0.0)) return std::nullopt;
  return -std::ilogb(sum / static_cast<double>(image.size()));
}

/// Times 2 to the `exponent`, within what a light can be.
void scale(std::vector<float>& image, int exponent) {
  for (float& value : image)
    value = std::isnan(value) ? 0.0f : std::clamp(std::ldexp(value, exponent), 0.0f, most);
}

/// Light that is seen directly has no noise, and may have details that no guide shows: a pixel keeps what was rendered
/// by the share of it. The filter is given all of the light nevertheless: without the sky, edges before the sky would
/// be softened, and be dark beside a sky that is not.
void keep_emission(const std::vector<float>& rendered, const std::vector<float>& emission,
                   std::vector<float>& denoised) {
  for (std::size_t i = 0; i < denoised.size(); i += 3) {
    const double all = double{rendered[i]} + double{rendered[i + 1]} + double{rendered[i + 2]};
    const double seen = double{emission[i]} + double{emission[i + 1]} + double{emission[i + 2]};
    const double share = all > 0.0 ? std::min(1.0, seen / all) : 0.0;
    for (std::size_t k = i; k < i + 3; ++k)
      denoised[k] = static_cast<float>(share * double{rendered[k]} + (1.0 - share) * double{denoised[k]});
  }
}

/// Albedo and normal without noise.
struct Guides {
  std::vector<float> albedo, normal;
};

} // namespace

const std::vector<ChannelName>& noisy_channels() {
  static const std::vector<ChannelName> names{{"Noisy.R", false}, {"Noisy.G", false}, {"Noisy.B", false}};
  return names;
}

void denoise_picture(const Denoiser& denoiser, const std::vector<ChannelName>& channels, Band& rows,
                     const std::function<void(double)>& progress) {
  const Places rgb = required(channels, ""), noisy = required(channels, "Noisy.");
  const Places emission = required(channels, "Denoise.Emission."), direct = required(channels, "Direct.");
  std::vector<Places> lights{direct};
  for (const char* prefix : {"Diffuse.", "Specular.", "Caustic."})
    if (const std::optional<Places> found = places_of(channels, prefix)) lights.push_back(*found);
  for (std::size_t k = 0; k < 3; ++k)
    rows.values[noisy[k]] = rows.values[rgb[k]];
  if (rows.rows == 0) return;

  const double filters = 2.0 + static_cast<double>(lights.size());
  double done = 0.0;
  const auto filter = [&](const DenoiseImages& images) {
    denoiser.filter(images);
    progress(++done / filters);
  };
  Guides guides{interleaved(rows, required(channels, "Denoise.Albedo."), 0.0f, 1.0f),
                interleaved(rows, required(channels, "Denoise.N.", "XYZ"), -1.0f, 1.0f)};
  DenoiseImages images;
  images.width = rows.width;
  images.height = rows.rows;
  images.albedo = images.output = guides.albedo.data();
  filter(images);
  images.albedo = nullptr;
  images.normal = images.output = guides.normal.data();
  filter(images);
  images.albedo = guides.albedo.data();
  images.clean = true;

  std::vector<std::pair<Places, std::vector<float>>> denoised;
  for (const Places& places : lights) {
    std::vector<float> light = interleaved(rows, places, 0.0f, most);
    const std::vector<float> rendered = places == direct ? light : std::vector<float>();
    if (const std::optional<int> exponent = exponent_of(light)) { // black has no noise
      scale(light, *exponent);
      images.light = images.output = light.data();
      filter(images);
      scale(light, -*exponent);
    }
    if (places == direct) keep_emission(rendered, interleaved(rows, emission, 0.0f, most), light);
    denoised.emplace_back(places, std::move(light));
  }
  for (const auto& [places, light] : denoised)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; 3 * i < light.size(); ++i)
        rows.values[places[k]][i] = light[3 * i + k];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < rows.values[rgb[k]].size(); ++i) {
      double sum = 0.0;
      for (const Places& places : lights)
        sum += double{rows.values[places[k]][i]};
      rows.values[rgb[k]][i] = static_cast<float>(sum);
    }
}

} // namespace pointgi
