#pragma once
/// Light of the surroundings where it is spread over them: few directions tell what they send.
#include "host/lights/environment_map.h"

namespace pointgi {

/// Whether the radiance of few directions tells the mean: its variance over all directions is at most three times the
/// square of the mean, in each colour. A small bright spot makes it larger.
bool is_smooth(const EnvironmentMap& map);

/// SMOOTH_SKY_SIDE x SMOOTH_SKY_SIDE texels of the map's radiance divided by `scale`, on the octahedron of
/// shared/sky_types.h: each the mean of directions in it, 4 x 4 or more, as the map has pixels.
std::vector<std::array<float, 4>> smooth_sky(const EnvironmentMap& map, double scale);

} // namespace pointgi
