#pragma once
/// Light of the surroundings where they have no detail: few directions tell what they send.
#include "host/lights/environment_map.h"

namespace pointgi {

/// Whether no texel of the map shines more than a few times as bright as the mean of all.
bool is_smooth(const EnvironmentMap& map);

/// SMOOTH_SKY_SIDE x SMOOTH_SKY_SIDE texels of the map's radiance divided by `scale`, on the octahedron of
/// shared/sky_types.h: each the mean of 4 x 4 directions in it.
std::vector<std::array<float, 4>> smooth_sky(const EnvironmentMap& map, double scale);

} // namespace pointgi
