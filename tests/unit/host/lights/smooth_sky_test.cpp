/// The coarse map of a sky without detail, against the map itself.
#include "host/lights/sky_model.h"
#include "host/lights/smooth_sky.h"
#include "tests/support/sky.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

EnvironmentMap clear_sky(UpAxis up, double elevation_deg, double turbidity = 3.0) {
  const SkyFrame frame = sky_frame(up, 25.0);
  return make_environment_map(sky_image(make_sky_model(frame, 120.0, elevation_deg, turbidity, 0.2), frame, 256, 128),
                              frame, 1.0, "sky");
}

/// The texel of the octahedron |x| + |y| + |z| = 1 that a direction meets, as its definition has it.
std::size_t texel_of(const Vector3d& direction) {
  const Vector3d d = direction / direction.lpNorm<1>();
  double x = d.x(), y = d.y();
  if (d.z() < 0.0) { // folded over the square's edges
    x = std::copysign(1.0 - std::fabs(d.y()), d.x());
    y = std::copysign(1.0 - std::fabs(d.x()), d.y());
  }
  const auto at = [](double v) {
    return std::min<std::size_t>(SMOOTH_SKY_SIDE - 1, static_cast<std::size_t>(0.5 * (v + 1.0) * SMOOTH_SKY_SIDE));
  };
  return SMOOTH_SKY_SIDE * at(y) + at(x);
}

} // namespace

TEST_CASE("a clear sky without its sun is smooth, a map with the sun in it is not") {
  for (const double elevation : {5.0, 15.0, 30.0, 60.0, 85.0})
    for (const double turbidity : {2.0, 3.0, 6.0}) {
      CAPTURE(elevation, turbidity);
      CHECK(is_smooth(clear_sky(UpAxis::z, elevation, turbidity)));
    }
  RgbImage image = grey_image(256, 128, [](int, int) { return 1.0f; });
  CHECK(is_smooth(make_environment_map(image, sky_frame(UpAxis::z, 0.0), 1.0, "even")));
  for (std::size_t c = 0; c < 3; ++c)
    image.rgb[3 * (40 * 256 + 100) + c] = 1000.0f;
  CHECK_FALSE(is_smooth(make_environment_map(image, sky_frame(UpAxis::z, 0.0), 1.0, "with a sun")));
  // A window of a sixteenth of all directions in the dark: the square's mean is sixteen times the mean's square.
  const RgbImage window = grey_image(64, 32, [](int x, int y) { return x < 8 && y >= 8 && y < 16 ? 1.0f : 0.0f; });
  CHECK_FALSE(is_smooth(make_environment_map(window, sky_frame(UpAxis::z, 0.0), 1.0, "window")));
}

TEST_CASE("the coarse map of a sky sends surfaces what the map sends") {
  for (const UpAxis up : {UpAxis::z, UpAxis::y}) {
    const EnvironmentMap map = clear_sky(up, 40.0);
    const auto coarse = smooth_sky(map, 2.0);
    REQUIRE(coarse.size() == SMOOTH_SKY_SIDE * SMOOTH_SKY_SIDE);
    for (const Vector3d& normal :
         {Vector3d(0, 0, 1), Vector3d(0, 1, 0), Vector3d(1, 0, 0), Vector3d(-1, -2, 0.5), Vector3d(0.3, -0.2, -0.9)}) {
      const Vector3d n = normal.normalized(), a = n.unitOrthogonal(), b = n.cross(a);
      Vector3d sum = Vector3d::Zero();
      constexpr int side = 300; // cells of the disc below the hemisphere: the sum's own error is below 1e-4
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const double u = (i + 0.5) / side, phi = 2.0 * 3.14159265358979 * (j + 0.5) / side;
          const Vector3d d = std::sqrt(u) * (std::cos(phi) * a + std::sin(phi) * b) + std::sqrt(1.0 - u) * n;
          for (int c = 0; c < 3; ++c)
            sum[c] += double{coarse[texel_of(d)][static_cast<std::size_t>(c)]};
        }
      const Vector3d found = 2.0 * 3.14159265358979 / (side * side) * sum, truth = irradiance(map, n);
      CAPTURE(n.transpose(), found.transpose(), truth.transpose());
      // Texels are 1.4 degrees wide or more: at the horizon sky and ground mix in half a texel.
      CHECK((found - truth).norm() < 0.01 * truth.norm());
    }
  }
}
