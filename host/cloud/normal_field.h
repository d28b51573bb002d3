#pragma once
/// How the normal changes over each splat: reflections on discs of one normal each would show the discs.
#include "octree/splat.h"
#include "octree/view.h"
#include <functional>
#include <vector>

namespace pointgi {

/// The normal at u a + v b from a splat's middle is n + u n_u + v n_v, of any length (Linsen, Müller, Rosenthal,
/// "Splat-based ray tracing of point clouds", 2007; method.md §6). Both slopes lie in the disc's plane, which loses
/// nothing of the first order: n_u = slope[0] a + slope[1] b, n_v = slope[2] a + slope[3] b, where (a, b) are
/// splat_tangents(n). 1 / root cube.
struct NormalSlopes {
  float slope[4] = {0.0f, 0.0f, 0.0f, 0.0f};
};

/// The device's `tangents` (kernels/lib/vector.cl): two unit vectors across the unit vector n.
void splat_tangents(const float n[3], float a[3], float b[3]);

/// Least squares over the normals of each splat's neighbours that are of its material and face its way within 60
/// degrees: a crease stays one. `wanted(splat)` says for which splats; the others, and those with too few neighbours,
/// have no slopes. One entry a splat, in order. Works on all cores, the same result for any number of them.
std::vector<NormalSlopes> fit_normal_field(View<Splat> splats, const std::function<bool(const Splat&)>& wanted);

} // namespace pointgi
