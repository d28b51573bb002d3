#include "octree/ref/closest_hit.h"
#include "octree/ref/clip.h"

namespace pointgi {

RayHit closest_hit(View<Splat> splats, const double origin[3], const double direction[3], double t_min, double t_max,
                   View<DiscClip> clips) {
  RayHit best{t_max, RayHit::none};
  for (std::size_t i = 0; i < splats.size; ++i) {
    const Splat& s = splats[i];
    double along = 0.0, towards = 0.0, offset[3];
    for (int a = 0; a < 3; ++a) {
      offset[a] = s.position[a] - origin[a];
      along += static_cast<double>(s.normal[a]) * offset[a];
      towards += static_cast<double>(s.normal[a]) * direction[a];
    }
    const double t = along / towards;
    if (!(t > t_min && t < best.t)) continue;
    double distance2 = 0.0, off[3];
    for (int a = 0; a < 3; ++a) {
      off[a] = t * direction[a] - offset[a];
      distance2 += off[a] * off[a];
    }
    if (clips.size != 0 && is_clipped_off(clips[i], off)) continue;
    if (distance2 <= static_cast<double>(s.radius) * s.radius) best = {t, static_cast<std::uint32_t>(i)};
  }
  if (best.splat == RayHit::none) best.t = -1.0;
  return best;
}

} // namespace pointgi
