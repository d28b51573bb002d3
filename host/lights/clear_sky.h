#pragma once
/// Sunlight through a clear atmosphere: what of it arrives along the beam, and what the air scatters down.
#include <Eigen/Core>

namespace pointgi {

using Eigen::Vector3d;

/// Turbidity as Preetham, Shirley and Smits have it: the optical thickness of air with haze over that of air alone; 2
/// is very clear, 3 clear, 6 hazy. Below 2 their sky has a horizon tens of times as bright as its zenith.
inline constexpr double lowest_turbidity = 2.0, highest_turbidity = 10.0;

/// Luminous efficacy of daylight [lm/W] over the whole solar spectrum, by which all light of sun and sky is turned from
/// lux into W/m². One number for both, so that their ratio is that of their luminances, which is what a picture shows.
/// 110 lies between a high sun's 100 and a clear sky's 130; a sun overhead at turbidity 2 gives 924 W/m² then, where
/// Bird's broadband model has 935.
inline constexpr double daylight_efficacy = 110.0;

/// CIE tristimulus values, Y in lux.
struct ClearSkyLight {
  Vector3d beam{0, 0, 0}; ///< on a surface across the beam
  double diffuse = 0.0;   ///< illuminance of the ground by the sky [lux]
};

/// With the sun's centre `sun_elevation_deg` above the horizon; nothing at 0 and below. Transmittances, spectrum and
/// coefficients of Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", 1999, appendix 1 (after
/// Iqbal, "An Introduction to Solar Radiation", 1983), for 0.35 cm of ozone and 2 cm of water; what the sky scatters
/// down by Bird and Riordan, "Simple solar spectral model for direct and diffuse irradiance on horizontal and tilted
/// planes", 1986. The earth's distance from the sun, 1.7 % either way, is left out.
ClearSkyLight clear_sky_light(double turbidity, double sun_elevation_deg);

/// Of tristimulus values, linear with the primaries of sRGB, times 1 / daylight_efficacy. Colours outside those
/// primaries are cut off at 0.
Vector3d daylight_rgb(const Vector3d& xyz);

} // namespace pointgi
