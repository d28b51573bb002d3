#include "host/lights/smooth_sky.h"
#include <cmath>

namespace pointgi {

namespace {

/// Of a place in [-1, 1]^2; not unit.
Vector3d on_octahedron(double x, double y) {
  const double z = 1.0 - std::fabs(x) - std::fabs(y);
  if (z >= 0.0) return {x, y, z};
  return {std::copysign(1.0 - std::fabs(y), x), std::copysign(1.0 - std::fabs(x), y), z};
}

} // namespace

bool is_smooth(const EnvironmentMap& map) {
  constexpr double most = 16.0; // of a clear sky, about its sun but without the disc, 4 to 12
  return largest_radiance(map) <= most * mean_radiance(map).maxCoeff();
}

std::vector<std::array<float, 4>> smooth_sky(const EnvironmentMap& map, double scale) {
  constexpr int side = SMOOTH_SKY_SIDE, places = 4;
  std::vector<std::array<float, 4>> texels(static_cast<std::size_t>(side) * side);
  const auto coordinate = [](int texel, int place) { return 2.0 * (texel + (place + 0.5) / places) / side - 1.0; };
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      Vector3d sum = Vector3d::Zero();
      for (int place = 0; place < places * places; ++place) {
        const Vector3d direction = on_octahedron(coordinate(column, place % places), coordinate(row, place / places));
        const SkyTexel& texel = map.texels[texel_towards(map, direction)];
        sum += Vector3d(texel.radiance[0], texel.radiance[1], texel.radiance[2]);
      }
      for (int c = 0; c < 3; ++c)
        texels[static_cast<std::size_t>(side * row + column)][static_cast<std::size_t>(c)] =
            static_cast<float>(sum[c] / (places * places * scale));
    }
  return texels;
}

} // namespace pointgi
