#pragma once
/// Light of the surroundings as a latitude-longitude map, with the tables by which kernels draw directions from it.
#include "host/image/rgb_image.h"
#include "host/lights/sky_frame.h"
#include "shared/sky_types.h"
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// Most texels of a map: 1 GiB of them.
inline constexpr std::size_t most_map_pixels = std::size_t{1} << 26;

/// The top row is at the zenith, the bottom one at the nadir; the middle of the picture is forward, its right side to
/// the right. Radiance is that of the nearest pixel, constant on each, so that the tables sample it exactly: a
/// direction's density [1/sr] is the luminance of its radiance over the luminance's integral, but for shares rounded to
/// 2^-24.
struct EnvironmentMap {
  int width = 0, height = 0;
  SkyFrame frame;
  std::vector<SkyTexel> texels;     ///< height x width; radiance [W/m²/sr]
  std::vector<SkyRow> rows;         ///< height
  std::vector<float> columns;       ///< height x width: cumulative share of each texel in its row; a row's last is 1
  bool is_black = false;            ///< no texel shines: there is nothing to sample
  std::optional<Vector3d> constant; ///< the radiance of all texels where they are equal
  std::vector<std::string> warnings;
};

/// Radiance is the image's times `scale`, >= 0. Values that are negative or not finite are taken as 0 and counted in a
/// warning, which begins with `name`.
EnvironmentMap make_environment_map(const RgbImage& image, const SkyFrame& frame, double scale,
                                    const std::string& name);

/// Reads .hdr and .pic (Radiance, radiance per EXPOSURE) and .exr (channels R, G and B), linear with the primaries of
/// sRGB. Throws Error(input) for another name, a file that is none, damaged or larger than most_map_pixels.
EnvironmentMap load_environment_map(const std::string& path, const SkyFrame& frame, double scale);

/// The texels with radiances divided by `scale`, as the device takes them.
std::vector<SkyTexel> device_texels(const EnvironmentMap& map, double scale);
/// The frame in the root cube, whose axes are the world's.
SkyMap device_sky_map(const EnvironmentMap& map);

/// Index of the texel in that direction, of any length above 0.
std::size_t texel_towards(const EnvironmentMap& map, const Vector3d& direction);

struct SkySample {
  Vector3d direction;
  std::size_t texel;
};
/// As the device draws: u[0] chooses the row, u[1] the column, u[2] and u[3] the place in the texel, all in [0, 1). The
/// map must not be black.
SkySample sample_map(const EnvironmentMap& map, const std::array<double, 4>& u);

/// Of any texel and colour [W/m²/sr].
double largest_radiance(const EnvironmentMap& map);

/// Mean over all directions [W/m²/sr]; times 4 pi is what a point receives.
Vector3d mean_radiance(const EnvironmentMap& map);

/// Irradiance [W/m²] of a surface with that unit normal and nothing around it. Texels that the horizon cuts are divided
/// into 16 x 16.
Vector3d irradiance(const EnvironmentMap& map, const Vector3d& normal);

} // namespace pointgi
