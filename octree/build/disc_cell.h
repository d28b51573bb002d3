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

/// Half extents of the disc's bounding box: r * sqrt(n_b² + n_c²) per axis.
void disc_half_extents(const Splat& splat, float half[3]);

/// Whether the splat-aligned square around the disc meets the cell widened by `cell_margin` (separating axes: the
/// cell's three, the disc's normal, the square's two sides). Conservative: true for every cell that the disc meets.
bool disc_touches_cell(const Splat& splat, const float half[3], const Cell& cell);

} // namespace pointgi
