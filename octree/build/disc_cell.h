#pragma once
/// Which cells a splat's disc touches: the test behind the extra splats.
#include "octree/splat.h"

namespace pointgi {

/// A cell of the tree: its corner and side, root cube units.
struct Cell {
  float low[3];
  float side;
};

/// How far outside a cell a disc still counts as touching it, root cube units. A hit computed in float lies within
/// about 3e-7 of the true one (coordinates below 2, a few roundings of 2^-24), and a ray must find the splat in
/// whichever cell the rounded hit falls; three times that, so that no disc is missed.
constexpr float cell_margin = 1e-6f;

/// Between which heights over its disc a patch lies: middle - half to middle + half. Both 0: the disc itself.
struct Slab {
  float middle = 0.0f, half = 0.0f; ///< along the splat's normal, root cube units
};

/// Of a patch with this bend on a disc of this radius.
Slab slab_of(const PatchBend& bend, float radius);

/// Half extents of the bounding box: r * sqrt(n_b² + n_c²) per axis for the disc, and the slab's. The box is about the
/// slab's middle, `slab_centre`.
void disc_half_extents(const Splat& splat, float half[3], const Slab& slab = {});
inline float slab_centre(const Splat& splat, const Slab& slab, int axis) {
  return splat.position[axis] + slab.middle * splat.normal[axis];
}

/// Whether the splat-aligned square around the disc, as thick as the slab, meets the cell widened by `cell_margin`
/// (separating axes: the cell's three, the disc's normal, the square's two sides). Conservative: true for every cell
/// that the disc, or its patch, meets. half: disc_half_extents.
bool disc_touches_cell(const Splat& splat, const float half[3], const Cell& cell, const Slab& slab = {});

} // namespace pointgi
