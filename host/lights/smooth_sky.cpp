#include "host/lights/smooth_sky.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Of a place in [-1, 1]^2; not unit.
Vector3d on_octahedron(double x, double y) {
  const double z = 1.0 - std::fabs(x) - std::fabs(y);
  if (z >= 0.0) return {x, y, z};
  return {std::copysign(1.0 - std::fabs(y), x), std::copysign(1.0 - std::fabs(x), y), z};
}

} // namespace

bool is_smooth(const EnvironmentMap& map) {
  // Relative to the square of the mean, over all directions. Of an even sky 1; of a clear one without its sun
  // 1.02 to 3.8.
  constexpr double most = 4.0;
  Vector3d squares = Vector3d::Zero();
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    const double solid_angle = double{map.rows[i / static_cast<std::size_t>(map.width)].solid_angle};
    for (int c = 0; c < 3; ++c)
      squares[c] += solid_angle * double{map.texels[i].radiance[c]} * double{map.texels[i].radiance[c]};
  }
  const Vector3d mean = mean_radiance(map);
  return (squares / (4.0 * pi)).cwiseQuotient(mean.cwiseProduct(mean).cwiseMax(1e-300)).maxCoeff() <= most;
}

std::vector<std::array<float, 4>> smooth_sky(const EnvironmentMap& map, double scale) {
  constexpr int side = SMOOTH_SKY_SIDE, fewest = 4, most = 32;
  // A texel's middle is 2.8 degrees wide: as many places in it as the map has pixels there.
  const int places = std::clamp(2 * map.height / side, fewest, most);
  std::vector<std::array<float, 4>> texels(static_cast<std::size_t>(side) * side);
  const auto coordinate = [&](int texel, int place) { return 2.0 * (texel + (place + 0.5) / places) / side - 1.0; };
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
