#include "host/lights/clear_sky.h"
#include <Eigen/Dense>
#include <cmath>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

/// One sample of the spectrum, 10 nm wide.
struct SpectralBand {
  double wavelength; ///< nm
  double sun;        ///< extraterrestrial radiance of the sun [W/m²/nm/sr] (Preetham et al., table 2)
  double ozone;      ///< absorption [1/m]
  double water;      ///< absorption [1/m]; that of other gases begins beyond 750 nm
  double x, y, z;    ///< CIE 1931 colour matching functions of 2 degrees
};

// clang-format off
constexpr SpectralBand bands[] = {
    {380, 16559, 0, 0, 0.001368, 3.9e-05, 0.00645},
    {390, 16233.7, 0, 0, 0.004243, 0.00012, 0.02005},
    {400, 21127.5, 0, 0, 0.01431, 0.000396, 0.06785},
    {410, 25888.2, 0, 0, 0.04351, 0.00121, 0.2074},
    {420, 25829.1, 0, 0, 0.13438, 0.004, 0.6456},
    {430, 24232.3, 0, 0, 0.2839, 0.0116, 1.3856},
    {440, 26760.5, 0, 0, 0.34828, 0.023, 1.74706},
    {450, 29658.3, 0.3, 0, 0.3362, 0.038, 1.77211},
    {460, 30545.4, 0.6, 0, 0.2908, 0.06, 1.6692},
    {470, 30057.5, 0.9, 0, 0.19536, 0.09098, 1.28764},
    {480, 30663.7, 1.4, 0, 0.09564, 0.13902, 0.81295},
    {490, 28830.4, 2.1, 0, 0.03201, 0.20802, 0.46518},
    {500, 28712.1, 3, 0, 0.0049, 0.323, 0.272},
    {510, 27825, 4, 0, 0.0093, 0.503, 0.1582},
    {520, 27100.6, 4.8, 0, 0.06327, 0.71, 0.07825},
    {530, 27233.6, 6.3, 0, 0.1655, 0.862, 0.04216},
    {540, 26361.3, 7.5, 0, 0.2904, 0.954, 0.0203},
    {550, 25503.8, 8.5, 0, 0.4334499, 0.9949501, 0.00875},
    {560, 25060.2, 10.3, 0, 0.5945, 0.995, 0.0039},
    {570, 25311.6, 12, 0, 0.7621, 0.952, 0.0021},
    {580, 25355.9, 12, 0, 0.9163, 0.87, 0.00165},
    {590, 25134.2, 11.5, 0, 1.0263, 0.757, 0.0011},
    {600, 24631.5, 12.5, 0, 1.0622, 0.631, 0.0008},
    {610, 24173.2, 12, 0, 1.0026, 0.503, 0.00034},
    {620, 23685.3, 10.5, 0, 0.8544499, 0.381, 0.00019},
    {630, 23212.1, 9, 0, 0.6424, 0.265, 5e-05},
    {640, 22827.7, 7.9, 0, 0.4479, 0.175, 2e-05},
    {650, 22339.8, 6.7, 0, 0.2835, 0.107, 0},
    {660, 21970.2, 5.7, 0, 0.1649, 0.061, 0},
    {670, 21526.7, 4.8, 0, 0.0874, 0.032, 0},
    {680, 21097.9, 3.6, 0, 0.04677, 0.017, 0},
    {690, 20728.3, 2.8, 1.6, 0.0227, 0.00821, 0},
    {700, 20240.4, 2.3, 2.4, 0.01135916, 0.004102, 0},
    {710, 19870.8, 1.8, 1.25, 0.005790346, 0.002091, 0},
    {720, 19427.2, 1.4, 100, 0.002899327, 0.001047, 0},
    {730, 19072.4, 1.1, 87, 0.001439971, 0.00052, 0},
    {740, 18628.9, 1, 6.1, 0.0006900786, 0.0002492, 0},
    {750, 18259.2, 0.9, 0.1, 0.0003323011, 0.00012, 0},
};
// clang-format on

constexpr double band_nm = 10.0;
constexpr double sun_solid_angle =
    6.7927e-5; ///< [sr] of the mean sun's radius of 0.2664 degrees, for the table's radiances
constexpr double lumens_per_watt = 683.0; ///< at 555 nm, by definition

/// Relative optical mass of the air (Kasten).
double air_mass(double zenith_deg) {
  return 1.0 / (std::cos(zenith_deg * pi / 180.0) + 0.15 * std::pow(93.885 - zenith_deg, -1.253));
}

/// Share of what haze scatters that goes down (Bird and Riordan): asymmetry 0.65.
double forward_share(double cosine) {
  const double a = std::log(1.0 - 0.65);
  const double first = a * (1.459 + a * (0.1595 + a * 0.4129)), second = a * (0.0783 + a * (-0.3824 - a * 0.5874));
  return 1.0 - 0.5 * std::exp((first + second * cosine) * cosine);
}

/// Shares of the beam that pass each of the atmosphere's parts.
struct Transmittance {
  double air, haze, gases;
  double haze_scattering, haze_absorption; ///< whose product is `haze`
};

Transmittance through(const SpectralBand& band, double mass, double turbidity) {
  const double micrometres = 1e-3 * band.wavelength;
  const double haze = (0.04608 * turbidity - 0.04586) * std::pow(micrometres, -1.3) * mass;
  const double scattered = 0.945 * std::exp(-0.095 * std::pow(std::log(micrometres / 0.4), 2)); // of what haze takes
  const double water = 0.02 * band.water * mass;
  Transmittance result{};
  result.air = std::exp(-0.008735 * std::pow(micrometres, -4.08) * mass);
  result.haze = std::exp(-haze);
  result.haze_scattering = std::exp(-scattered * haze);
  result.haze_absorption = std::exp(-(1.0 - scattered) * haze);
  result.gases =
      std::exp(-0.0035 * band.ozone * mass) * std::exp(-0.2385 * water / std::pow(1.0 + 20.07 * water, 0.45));
  return result;
}

} // namespace

ClearSkyLight clear_sky_light(double turbidity, double sun_elevation_deg) {
  ClearSkyLight light;
  if (!(sun_elevation_deg > 0.0)) return light;
  const double mass = air_mass(90.0 - sun_elevation_deg), cosine = std::sin(sun_elevation_deg * pi / 180.0);
  const double downward = forward_share(cosine);
  for (const SpectralBand& band : bands) {
    const Transmittance t = through(band, mass, turbidity);
    const double sun = band.sun * sun_solid_angle * band_nm * lumens_per_watt;
    light.beam += sun * t.air * t.haze * t.gases * Vector3d(band.x, band.y, band.z);
    const double by_air = 0.5 * (1.0 - std::pow(t.air, 0.95));
    const double by_haze = downward * std::pow(t.air, 1.5) * (1.0 - t.haze_scattering);
    light.diffuse += sun * cosine * t.gases * t.haze_absorption * (by_air + by_haze) * band.y;
  }
  return light;
}

Vector3d daylight_rgb(const Vector3d& xyz) {
  Eigen::Matrix3d to_rgb; // IEC 61966-2-1
  to_rgb << 3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252;
  return (to_rgb * xyz).cwiseMax(0.0) / daylight_efficacy;
}

} // namespace pointgi
