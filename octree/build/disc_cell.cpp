#include "octree/build/disc_cell.h"
#include <cmath>

namespace pointgi {

void disc_half_extents(const Splat& splat, float half[3]) {
  // The two other components, not 1 - n_a²: that loses the extent of a disc that is nearly axis-parallel.
  const float* n = splat.normal;
  for (int a = 0; a < 3; ++a)
    half[a] = splat.radius * std::sqrt(n[(a + 1) % 3] * n[(a + 1) % 3] + n[(a + 2) % 3] * n[(a + 2) % 3]);
}

namespace {

/// Distance of the cell's centre from the splat along `axis`, less the cell's own half width along it.
float separation(const float axis[3], const float offset[3], float half_side) {
  const float distance = std::fabs(axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2]);
  return distance - half_side * (std::fabs(axis[0]) + std::fabs(axis[1]) + std::fabs(axis[2]));
}

} // namespace

bool disc_touches_cell(const Splat& splat, const float half[3], const Cell& cell) {
  const float half_side = 0.5f * cell.side + cell_margin;
  float offset[3];
  for (int a = 0; a < 3; ++a) {
    offset[a] = cell.low[a] + 0.5f * cell.side - splat.position[a];
    if (std::fabs(offset[a]) > half_side + half[a]) return false;
  }
  const float* n = splat.normal;
  if (separation(n, offset, half_side) > 0.0f) return false;
  // The square's sides: any two unit vectors across the normal; Duff et al. 2017, "Building an orthonormal basis".
  const float sign = std::copysign(1.0f, n[2]);
  const float a = -1.0f / (sign + n[2]);
  const float b = n[0] * n[1] * a;
  const float u[3] = {1.0f + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
  const float v[3] = {b, sign + n[1] * n[1] * a, -n[1]};
  return separation(u, offset, half_side) <= splat.radius && separation(v, offset, half_side) <= splat.radius;
}

} // namespace pointgi
