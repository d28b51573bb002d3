#include "host/lights/sky_model.h"
#include "host/error.h"
#include <algorithm>
#include <cmath>
#include <string>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Distribution of luminance or chromaticity relative to the zenith's (Perez), up to a factor.
double perez(const std::array<double, 5>& c, double cosine, double angle_with_sun) {
  const double in_sun = std::cos(angle_with_sun);
  return (1.0 + c[0] * std::exp(c[1] / cosine)) *
         (1.0 + c[2] * std::exp(c[3] * angle_with_sun) + c[4] * in_sun * in_sun);
}

/// Preetham et al., appendix 2.
std::array<std::array<double, 5>, 3> perez_coefficients(double t) {
  return {
      {{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
       {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
       {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529}}};
}

/// [cd/m²], x, y for the sun at `angle`, radians, from the zenith.
Vector3d zenith_light(double t, double angle) {
  const double chi = (4.0 / 9.0 - t / 120.0) * (pi - 2.0 * angle);
  const double luminance = 1000.0 * ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192);
  const auto cubic = [&](double a, double b, double c, double d) { return ((a * angle + b) * angle + c) * angle + d; };
  const double x = t * (t * cubic(0.00166, -0.00375, 0.00209, 0.0) + cubic(-0.02903, 0.06377, -0.03202, 0.00394)) +
                   cubic(0.11693, -0.21196, 0.06052, 0.25886);
  const double y = t * (t * cubic(0.00275, -0.00610, 0.00317, 0.0) + cubic(-0.04214, 0.08970, -0.04153, 0.00516)) +
                   cubic(0.15346, -0.26756, 0.06670, 0.26688);
  return {luminance, x, y};
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return 2.0 * std::atan2((a - b).norm(), (a + b).norm());
}

Vector3d xyz_of(const Vector3d& light) {
  const double luminance = light.x(), x = light.y(), y = light.z();
  return luminance * Vector3d(x / y, 1.0, (1.0 - x - y) / y);
}

/// Integral over the upper hemisphere of value(direction) times the cosine with `up`.
template <typename Value>
auto over_sky(const SkyFrame& frame, const Value& value) {
  constexpr int rows = 64, columns = 128;
  auto sum = value(frame.up);
  sum *= 0.0;
  for (int j = 0; j < rows; ++j) { // equal steps of the squared cosine: equal parts of the integral of the cosine
    const double cosine = std::sqrt((j + 0.5) / rows), sine = std::sqrt(1.0 - (j + 0.5) / rows);
    for (int i = 0; i < columns; ++i) {
      const double azimuth = 2.0 * pi * (i + 0.5) / columns;
      sum += value(
          Vector3d(sine * (std::sin(azimuth) * frame.right + std::cos(azimuth) * frame.forward) + cosine * frame.up));
    }
  }
  sum *= pi / (rows * columns);
  return sum;
}

void require(bool holds, const std::string& what) {
  if (!holds) throw Error(ErrorKind::input, "sky: " + what);
}

} // namespace

SkyModel make_sky_model(const SkyFrame& frame, double sun_azimuth_deg, double sun_elevation_deg, double turbidity,
                        double ground_albedo) {
  require(turbidity >= lowest_turbidity && turbidity <= highest_turbidity,
          "turbidity " + std::to_string(turbidity) + ", expected 2 to 10; 2 is very clear air, 3 clear, 6 haze");
  require(ground_albedo >= 0.0 && ground_albedo <= 1.0,
          "albedo of the ground " + std::to_string(ground_albedo) + ", expected 0 to 1; 0.2 is grass or soil");
  SkyModel model;
  model.up = frame.up;
  model.towards_sun = sky_direction(frame, sun_azimuth_deg, sun_elevation_deg);
  model.sun_cosine = std::sin(sun_elevation_deg * pi / 180.0);
  model.is_night = !(sun_elevation_deg > 0.0);
  if (model.is_night) return model;
  const double angle = (90.0 - sun_elevation_deg) * pi / 180.0;
  const ClearSkyLight light = clear_sky_light(turbidity, sun_elevation_deg);
  model.perez = perez_coefficients(turbidity);
  model.zenith = zenith_light(turbidity, angle);
  model.sun_irradiance = daylight_rgb(light.beam);
  const double published =
      over_sky(frame, [&](const Vector3d& direction) { return preetham_luminance(model, direction).x(); });
  model.scale = light.diffuse / published;
  model.sky_irradiance = over_sky(frame, [&](const Vector3d& direction) { return sky_radiance(model, direction); });
  model.ground_radiance =
      ground_albedo / pi * (model.sky_irradiance + model.sun_irradiance * std::fmax(0.0, model.sun_cosine));
  return model;
}

Vector3d preetham_luminance(const SkyModel& model, const Vector3d& direction) {
  const double cosine = std::fmax(0.0, direction.dot(model.up)), with_sun = angle_between(direction, model.towards_sun);
  const double sun_angle = angle_between(model.up, model.towards_sun);
  Vector3d light;
  for (int k = 0; k < 3; ++k) {
    const std::array<double, 5>& c = model.perez[static_cast<std::size_t>(k)];
    light[k] = model.zenith[k] * perez(c, cosine, with_sun) / perez(c, 1.0, sun_angle);
  }
  return light;
}

Vector3d sky_radiance(const SkyModel& model, const Vector3d& direction) {
  if (model.is_night) return Vector3d::Zero();
  if (direction.dot(model.up) < 0.0) return model.ground_radiance;
  return daylight_rgb(model.scale * xyz_of(preetham_luminance(model, direction)));
}

RgbImage sky_image(const SkyModel& model, const SkyFrame& frame, int width, int height) {
  RgbImage image;
  image.width = width;
  image.height = height;
  image.rgb.reserve(3 * image.pixels());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vector3d direction =
          sky_direction(frame, 360.0 * ((x + 0.5) / width - 0.5), 90.0 - 180.0 * (y + 0.5) / height);
      const Vector3d radiance = sky_radiance(model, direction);
      for (int k = 0; k < 3; ++k)
        image.rgb.push_back(static_cast<float>(radiance[k]));
    }
  return image;
}

} // namespace pointgi
