#pragma once
/// A splat in the root cube, as the octree's builders take it.
#include "shared/octree_types.h"
#include <cstddef>

namespace pointgi {

/// The device's own point: position in [0,1)^3, unit normal, radius > 0 (root cube units).
using Splat = OctreePoint;

/// Index into the materials.
inline std::size_t material_of(const Splat& splat) {
  return static_cast<std::size_t>(splat.material);
}

/// Whether the splat is one side of a sheet (shared/octree_types.h), and which.
inline bool is_sheet(const Splat& splat) {
  return SHEET_SIDE(splat.material) != 0.0f;
}
inline bool is_back_of_sheet(const Splat& splat) {
  return SHEET_SIDE(splat.material) == SHEET_BACK;
}

static_assert(sizeof(OctreePoint) == 16 * POINT_TEXELS, "a point is three texels");
static_assert(sizeof(OctreeNode) == 16, "a node is one texel");

} // namespace pointgi
