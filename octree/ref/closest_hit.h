#pragma once
/// Brute-force truth for every traversal: a linear scan over all splats.
#include "octree/splat.h"
#include "octree/view.h"
#include <cstdint>

namespace pointgi {

struct RayHit {
  static constexpr std::uint32_t none = 0xffffffffu;
  double t = -1.0;
  std::uint32_t splat = none;
};

/// Nearest hit with t in (t_min, t_max) of the ray origin + t * direction with the splats' discs (method.md §6), in
/// double precision. `clips`: of each splat, zero where it has none; empty: none has. O(n).
RayHit closest_hit(View<Splat> splats, const double origin[3], const double direction[3], double t_min, double t_max,
                   View<DiscClip> clips = {});

} // namespace pointgi
