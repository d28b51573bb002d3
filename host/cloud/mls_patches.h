#pragma once
/// The moving-least-squares surface: each splat's disc becomes a patch of a quadratic.
#include "octree/splat.h"

namespace pointgi {

/// Splats belong to one surface whose normals are nearer than this, as discs that are blended
/// (kernels/surface/blend.cl): a patch bends towards such neighbours, and ends at its cell where a surface bends
/// outwards to others (host/cloud/disc_borders.h).
constexpr double mls_surface_cosine = 0.5;

struct MlsPatches {
  PatchBends bends;        ///< one a splat
  std::size_t patches = 0; ///< splats with a quadratic of their own, both sides of a sheet counted as one
  std::size_t planes = 0;  ///< whose neighbours allow a plane only
  std::size_t discs = 0;   ///< left as they were: flat by construction, or neighbours form no surface
};

/// Fits a patch to each splat that is not flat by construction (FLAT). In a frame at the splat, the heights f_i of its
/// k nearest neighbours at (x_i, y_i) are fitted by b = [1, x, y, x², xy, y²]: the least sum of theta(d_i / d_k)
/// (b(x_i)^T c - f_i)², Wendland's theta(r) = (1-r)^4 (4r+1) with the distance d_k of the k-th neighbour (Min and Kim;
/// method.md §8). The splat moves to the foot (0, 0, c_0) and takes the gradient there as its normal, until both stay;
/// c_3..c_5 of a fit in that frame are its bend. Its disc is then the tangent disc of the patch. Neighbours count that
/// have its material and face its way within 60 degrees; past its own clip, within 37. `neighbours`: k, 7 or more.
/// Works on all cores, the same result for any number of them.
MlsPatches fit_mls_patches(std::vector<Splat>& splats, const SplatClips& clips, unsigned neighbours);

} // namespace pointgi
