#pragma once
/// A splat in the root cube, as the octree's builders take it.
#include "shared/octree_types.h"

namespace pointgi {

/// The device's own point: position in [0,1)^3, unit normal, radius > 0 (root cube units).
using Splat = OctreePoint;

static_assert(sizeof(OctreePoint) == 16 * POINT_TEXELS, "a point is three texels");
static_assert(sizeof(OctreeNode) == 16, "a node is one texel");

} // namespace pointgi
