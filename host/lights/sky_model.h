#pragma once
/// A clear sky with its sun.
#include "host/image/rgb_image.h"
#include "host/lights/clear_sky.h"
#include "host/lights/sky_frame.h"
#include <array>

namespace pointgi {

/// Angular diameter of the sun's disc.
inline constexpr double sun_diameter_deg = 0.53;

/// The luminance and chromaticity of Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", 1999, as
/// functions of direction. Their absolute luminance is not taken: the sky would send the ground two to three times what
/// the air scatters, and with the sun more than arrives from space (turbidity 10, sun overhead: 1459 of 1367 W/m²).
/// Instead all of it is scaled so that the ground receives clear_sky_light().diffuse.
struct SkyModel {
  Vector3d up, towards_sun;
  double sun_cosine = 0.0; ///< of the sun's angle with the zenith
  bool is_night = false;   ///< the sun's centre is not above the horizon: no light at all, as the model has no twilight
  std::array<std::array<double, 5>, 3> perez{}; ///< A to E of luminance, x and y
  Vector3d zenith{0, 0, 0};                     ///< luminance [cd/m²], as published, and chromaticity x and y
  double scale = 0.0;                           ///< of the published luminance
  Vector3d sun_irradiance{0, 0, 0};             ///< [W/m²] of a surface across the beam
  Vector3d sky_irradiance{0, 0, 0};             ///< [W/m²] of the ground by the sky alone
  Vector3d ground_radiance{0, 0, 0};            ///< [W/m²/sr] below the horizon: a grey ground that sun and sky light
};

/// Azimuth from the frame's forward, clockwise; turbidity from lowest_turbidity to highest_turbidity; albedo of the
/// ground from 0 to 1. Throws Error(input) for a turbidity or albedo outside these.
SkyModel make_sky_model(const SkyFrame& frame, double sun_azimuth_deg, double sun_elevation_deg, double turbidity,
                        double ground_albedo);

/// Luminance [cd/m²] and chromaticity x, y as published, towards a unit direction above the horizon.
Vector3d preetham_luminance(const SkyModel& model, const Vector3d& direction);

/// [W/m²/sr] from the unit direction, without the sun's disc; below the horizon that of the ground.
Vector3d sky_radiance(const SkyModel& model, const Vector3d& direction);

/// The sky as a latitude-longitude map (host/lights/environment_map.h), each pixel the radiance at its centre. An even
/// height lets the horizon fall between two rows.
RgbImage sky_image(const SkyModel& model, const SkyFrame& frame, int width, int height);

} // namespace pointgi
