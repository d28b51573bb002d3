#pragma once
/// Brute-force truth for rays against patches of the moving-least-squares surface.
#include "octree/ref/closest_hit.h"

namespace pointgi {

/// closest_hit with the splats' patches in place of their discs: on the part of the ray over a patch's disc, its height
/// over the patch is cut where it turns, and each monotone part bisected, in double precision. `bends`: one a splat.
/// O(n).
RayHit closest_patch_hit(View<Splat> splats, View<PatchBend> bends, const double origin[3], const double direction[3],
                         double t_min, double t_max, View<DiscClip> clips = {});

} // namespace pointgi
