/// The clear sky and its sun: energy, colours, where it is bright, and what becomes of it as a map and a disc.
#include "host/error.h"
#include "host/lights/environment_map.h"
#include "host/lights/sky_model.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;

namespace {

constexpr double pi = 3.14159265358979323846;
const SkyFrame frame = sky_frame(UpAxis::z, 0.0);

double luminance(const Vector3d& c) {
  return c.dot(Vector3d(0.2126, 0.7152, 0.0722));
}

SkyModel sky(double turbidity, double elevation, double albedo = 0.2) {
  return make_sky_model(frame, 120.0, elevation, turbidity, albedo);
}

/// Irradiance of the ground by the sky, by the midpoint rule in angle: not the rule that the model uses itself.
Vector3d ground_irradiance(const SkyModel& model) {
  constexpr int rows = 90, columns = 180;
  Vector3d sum = Vector3d::Zero();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double elevation = 90.0 * (j + 0.5) / rows, e = elevation * pi / 180.0;
      sum += sky_radiance(model, sky_direction(frame, 360.0 * i / columns, elevation)) * std::sin(e) * std::cos(e);
    }
  return sum * (0.5 * pi / rows) * (2.0 * pi / columns);
}

} // namespace

TEST_CASE("a clear sky sends the ground what instruments measure") {
  // Very clear to clear air, sun at 40 to 90 degrees: diffuse horizontal 100 to 200 W/m², direct normal 700 to 950 W/m²
  // (a broadband model's values are in independent_sky_test.cpp).
  for (const double turbidity : {2.0, 2.5, 3.0})
    for (const double elevation : {40.0, 60.0, 90.0}) {
      INFO("turbidity " << turbidity << ", sun at " << elevation);
      const SkyModel model = sky(turbidity, elevation);
      CHECK(luminance(model.sun_irradiance) > 690.0);
      CHECK(luminance(model.sun_irradiance) < 950.0);
      CHECK(luminance(model.sky_irradiance) > 100.0);
      CHECK(luminance(model.sky_irradiance) < 200.0);
      // Two midpoint rules; the model's rows are widest at the horizon, where the sky changes most.
      CHECK(luminance(ground_irradiance(model)) == Approx(luminance(model.sky_irradiance)).epsilon(0.02));
    }
  // Turbidity 2.5, sun high: about 900 W/m² along the beam.
  CHECK(luminance(sky(2.5, 80.0).sun_irradiance) == Approx(900.0).epsilon(0.05));
}

TEST_CASE("no turbidity and no sun give the ground more than arrives from space") {
  for (double turbidity = 2.0; turbidity <= 10.0; turbidity += 1.0) {
    double before = 0.0;
    for (double elevation = 1.0; elevation <= 90.0; elevation += 1.0) {
      const SkyModel model = sky(turbidity, elevation);
      const double sine = std::sin(elevation * pi / 180.0);
      const double ground = luminance(model.sky_irradiance + model.sun_irradiance * sine);
      CHECK(ground < 1361.0 * sine); // the solar constant, Kopp and Lean 2011
      CHECK(ground > before);
      before = ground;
    }
  }
  // More haze: less of the beam, more from the sky.
  for (double turbidity = 2.0; turbidity < 9.5; turbidity += 0.5) {
    CHECK(luminance(sky(turbidity, 50.0).sun_irradiance) > luminance(sky(turbidity + 0.5, 50.0).sun_irradiance));
    CHECK(luminance(sky(turbidity, 50.0).sky_irradiance) < luminance(sky(turbidity + 0.5, 50.0).sky_irradiance));
  }
}

TEST_CASE("the sky is as published where it is not scaled") {
  // By hand from the paper's formulas. Turbidity 2, sun in the zenith: chi = (4/9 - 2/120) pi = 1.34390, its tangent
  // 4.33148, luminance 3.1196 * 4.33148 - 0.4310 + 2.4192 = 15.5007 kcd/m².
  const SkyModel noon = sky(2.0, 90.0);
  const Vector3d zenith = preetham_luminance(noon, Vector3d::UnitZ());
  CHECK(zenith.x() == Approx(15500.7).epsilon(1e-4));
  // The zenith's chromaticity is the last column alone: 0.25886 + 2 * 0.00394, 0.26688 + 2 * 0.00516.
  CHECK(zenith.y() == Approx(0.26674).epsilon(1e-6));
  CHECK(zenith.z() == Approx(0.27720).epsilon(1e-6));
  // At 60 degrees from it, luminance: A = -1.1056, B = -0.2833, C = 5.2797, D = -2.3359, E = 0.2363:
  // (1 + A e^(B / 0.5)) (1 + C e^(D pi / 3) + E / 4) over (1 + A e^B) (1 + C + E) = 0.372626 * 1.516437 / 1.089204.
  const Vector3d low = preetham_luminance(noon, sky_direction(frame, 10.0, 30.0));
  CHECK(low.x() / zenith.x() == Approx(0.372626 * 1.516437 / 1.089204).epsilon(1e-4));
  // In radiance only the scale differs.
  CHECK(luminance(sky_radiance(noon, Vector3d::UnitZ())) ==
        Approx(noon.scale * zenith.x() / daylight_efficacy).epsilon(1e-3)); // primaries are given with 4 digits
}

TEST_CASE("the sky is bright about the sun and at the horizon, blue above, and its sun reddens as it sets") {
  const SkyModel model = sky(2.5, 40.0);
  const auto bright = [&](double azimuth, double elevation) {
    return luminance(sky_radiance(model, sky_direction(frame, azimuth, elevation)));
  };
  CHECK(bright(120.0, 40.0) > 2.0 * bright(300.0, 40.0));
  CHECK(bright(120.0, 41.0) > bright(120.0, 60.0));
  CHECK(bright(300.0, 2.0) > 2.0 * bright(300.0, 60.0));
  CHECK(bright(110.0, 30.0) == Approx(bright(130.0, 30.0)).epsilon(1e-9)); // even about the sun's meridian
  const Vector3d zenith = sky_radiance(model, Vector3d::UnitZ());
  CHECK(zenith.z() > 1.5 * zenith.x());
  double before = 0.0;
  for (const double elevation : {80.0, 40.0, 20.0, 10.0, 5.0, 2.0}) {
    const Vector3d sun = sky(2.5, elevation).sun_irradiance;
    CHECK(sun.x() / sun.y() > before);
    before = sun.x() / sun.y();
  }
  CHECK(before > 2.0);
  const Vector3d high = sky(2.0, 90.0).sun_irradiance; // nearly white: daylight is the white of sRGB
  CHECK(high.x() / high.z() == Approx(1.1).margin(0.2));
}

TEST_CASE("below the horizon lies a ground that sun and sky light") {
  const SkyModel model = sky(3.0, 30.0, 0.4);
  const Vector3d ground = sky_radiance(model, sky_direction(frame, 77.0, -20.0));
  CHECK(ground.isApprox(0.4 / pi * (model.sky_irradiance + 0.5 * model.sun_irradiance), 1e-12));
  CHECK(sky_radiance(sky(3.0, 30.0, 0.0), sky_direction(frame, 77.0, -20.0)).norm() == 0.0);
}

TEST_CASE("without a sun above the horizon there is no light, and just above it little") {
  for (const double elevation : {0.0, -0.5, -40.0}) {
    const SkyModel night = sky(3.0, elevation);
    CHECK(night.is_night);
    CHECK(night.sun_irradiance.norm() == 0.0);
    CHECK(sky_radiance(night, Vector3d::UnitZ()).norm() == 0.0);
    CHECK(sky_radiance(night, -Vector3d::UnitZ()).norm() == 0.0);
  }
  const SkyModel dawn = sky(3.0, 0.01);
  CHECK_FALSE(dawn.is_night);
  CHECK(luminance(dawn.sky_irradiance) > 0.0);
  CHECK(luminance(dawn.sky_irradiance) < 1.0);
}

TEST_CASE("every direction, turbidity and sun gives finite colours that are not negative") {
  for (const double turbidity : {2.0, 4.0, 10.0})
    for (const double elevation : {0.1, 5.0, 45.0, 90.0}) {
      const SkyModel model = sky(turbidity, elevation);
      for (double e = -90.0; e <= 90.0; e += 5.0)
        for (double a = 0.0; a < 360.0; a += 15.0) {
          const Vector3d radiance = sky_radiance(model, sky_direction(frame, a, e));
          REQUIRE(radiance.allFinite());
          REQUIRE(radiance.minCoeff() >= 0.0);
        }
    }
}

TEST_CASE("the sky as a map lights a surface as the sky does") {
  for (const UpAxis up : {UpAxis::z, UpAxis::y}) {
    const SkyFrame turned = sky_frame(up, 25.0);
    const SkyModel model = make_sky_model(turned, 120.0, 35.0, 2.5, 0.2);
    const EnvironmentMap map = make_environment_map(sky_image(model, turned, 256, 128), turned, 1.0, "sky");
    CHECK(map.warnings.empty());
    // Two midpoint rules, the model's and the map's rows of 1.4 degrees.
    CHECK(luminance(irradiance(map, turned.up)) == Approx(luminance(model.sky_irradiance)).epsilon(0.02));
    CHECK(luminance(irradiance(map, -turned.up)) == Approx(pi * luminance(model.ground_radiance)).epsilon(1e-4));
    // Brightest where the sun is, to a pixel.
    std::size_t brightest = 0;
    for (std::size_t i = 0; i < map.texels.size() / 4; ++i) // above 45 degrees is no horizon
      if (map.texels[i].radiance[1] > map.texels[brightest].radiance[1]) brightest = i;
    const double azimuth = 360.0 * ((static_cast<double>(brightest % 256) + 0.5) / 256.0 - 0.5);
    CHECK(azimuth == Approx(120.0).margin(360.0 / 256.0));
    CHECK((sky_direction(turned, 120.0, 35.0) - model.towards_sun).norm() < 1e-12);
  }
}

TEST_CASE("a sky outside its model's range is refused") {
  for (const double turbidity : {1.9, 10.1, -1.0, std::nan("")})
    CHECK_THROWS_WITH(sky(turbidity, 30.0), Catch::Contains("turbidity") && Catch::Contains("2 to 10"));
  for (const double albedo : {-0.1, 1.1, std::nan("")})
    CHECK_THROWS_WITH(sky(3.0, 30.0, albedo), Catch::Contains("albedo"));
}
