#include "host/radiosity/occupancy.h"
#include "octree/build/disc_cell.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pointgi {

std::vector<std::uint32_t> occupied_voxels(View<Splat> splats, unsigned side) {
  if (side == 0 || side % 32 != 0) throw std::invalid_argument("an occupancy grid's side is no multiple of 32");
  std::vector<std::uint32_t> words(std::size_t{side} * side * side / 32);
  const auto last = static_cast<int>(side) - 1;
  const float voxel = 1.0f / static_cast<float>(side);
  for (const Splat& splat : splats) {
    float half[3];
    disc_half_extents(splat, half);
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      const auto at = [&](float x) {
        return std::clamp(static_cast<int>(std::floor(x * static_cast<float>(side))), 0, last);
      };
      low[a] = at(splat.position[a] - half[a]);
      high[a] = at(splat.position[a] + half[a]);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const Cell cell{{static_cast<float>(x) * voxel, static_cast<float>(y) * voxel, static_cast<float>(z) * voxel},
                          voxel};
          const std::size_t bit =
              (static_cast<std::size_t>(z) * side + static_cast<std::size_t>(y)) * side + static_cast<std::size_t>(x);
          if (disc_touches_cell(splat, half, cell)) words[bit / 32] |= 1u << bit % 32;
        }
  }
  return words;
}

Occupancy upload_occupancy(Session& session, View<Splat> splats, unsigned side) {
  return {side, session.upload(occupied_voxels(splats, side))};
}

} // namespace pointgi
