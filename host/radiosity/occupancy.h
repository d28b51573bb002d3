#pragma once
/// Which voxels of the root cube hold some of a surface: visibility for those who can do with a rough one (method.md
/// §8).
#include "host/cl/session.h"
#include "octree/splat.h"
#include "octree/view.h"
#include <cstdint>
#include <optional>
#include <vector>

namespace pointgi {

/// A bit a voxel, bit (z side + y) side + x of 32-bit words: 1 where some splat's disc touches it. `side`: voxels along
/// an axis of the root cube, a multiple of 32. Throws std::invalid_argument.
std::vector<std::uint32_t> occupied_voxels(View<Splat> splats, unsigned side);

/// The same on the device.
struct Occupancy {
  unsigned side = 0;
  Buffer<cl_uint> words;

  /// SIGHT_PARAMS of kernels/visibility/sight.cl.
  std::vector<cl::Memory> arguments() const { return {words.handle}; }
};

Occupancy upload_occupancy(Session& session, View<Splat> splats, unsigned side);

/// What programs are built for: 0 without a grid.
inline unsigned voxels_of(const std::optional<Occupancy>& occupancy) {
  return occupancy ? occupancy->side : 0;
}

} // namespace pointgi
