#include "octree/build/disc_cell.h"
#include <algorithm>
#include <cmath>

namespace pointgi {

Slab slab_of(const PatchBend& bend, float radius) {
  // The least and the greatest of x (xx x + xy y) + yy y y on the unit circle, widened by rounding; 0 at the centre.
  const float mean = 0.5f * (bend.xx + bend.yy), apart = std::hypot(0.5f * (bend.xx - bend.yy), 0.5f * bend.xy);
  if (mean == 0.0f && apart == 0.0f) return {};
  const float r2 = radius * radius, rounding = 1e-5f * (std::fabs(mean) + apart) * r2;
  const float most = PATCH_HEIGHT * radius;
  const float low = std::max(std::min(0.0f, (mean - apart) * r2), -most) - rounding;
  const float high = std::min(std::max(0.0f, (mean + apart) * r2), most) + rounding;
  return {0.5f * (low + high), 0.5f * (high - low)};
}

void disc_half_extents(const Splat& splat, float half[3], const Slab& slab) {
  // The two other components, not 1 - n_a²: that loses the extent of a disc that is nearly axis-parallel.
  const float* n = splat.normal;
  for (int a = 0; a < 3; ++a)
    half[a] = splat.radius * std::sqrt(n[(a + 1) % 3] * n[(a + 1) % 3] + n[(a + 2) % 3] * n[(a + 2) % 3]) +
              slab.half * std::fabs(n[a]);
}

namespace {

/// Distance of the cell's centre from the splat along `axis`, less the cell's own half width along it.
float separation(const float axis[3], const float offset[3], float half_side) {
  const float distance = std::fabs(axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2]);
  return distance - half_side * (std::fabs(axis[0]) + std::fabs(axis[1]) + std::fabs(axis[2]));
}

} // namespace

bool disc_touches_cell(const Splat& splat, const float half[3], const Cell& cell, const Slab& slab) {
  const float half_side = 0.5f * cell.side + cell_margin;
  float offset[3];
  for (int a = 0; a < 3; ++a) {
    offset[a] = cell.low[a] + 0.5f * cell.side - slab_centre(splat, slab, a);
    if (std::fabs(offset[a]) > half_side + half[a]) return false;
  }
  const float* n = splat.normal;
  if (separation(n, offset, half_side) > slab.half) return false;
  // The square's sides: any two unit vectors across the normal; Duff et al. 2017, "Building an orthonormal basis".
  const float sign = std::copysign(1.0f, n[2]);
  const float a = -1.0f / (sign + n[2]);
  const float b = n[0] * n[1] * a;
  const float u[3] = {1.0f + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
  const float v[3] = {b, sign + n[1] * n[1] * a, -n[1]};
  return separation(u, offset, half_side) <= splat.radius && separation(v, offset, half_side) <= splat.radius;
}

} // namespace pointgi
