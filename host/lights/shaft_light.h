#pragma once
/// Light at points that see all of every lamp and [[light]]: by sums instead of shadow rays, without noise (Haines and
/// Wallace, "Shaft culling for efficient ray-traced radiosity", 1991, decides where; octree/vmap/shafts.h).
#include "host/scene/lighting.h"

namespace pointgi {

struct ShaftLight {
  std::vector<float> irradiance;   ///< [points x 3], W/m² divided by the lighting's scale; 0 where it is not known
  std::vector<std::uint8_t> known; ///< [points]: 1 where it is: each lamp and [[light]] is behind the point's plane, or
                                   ///< shines on all of its disc
  std::size_t known_points = 0;
};

/// Of every [[light]] and all emitting splats together, not of the sky. `points`: the pool, discs. Nothing is known
/// where the scene has more lamps than shafts are worth (most_lamps), of lamps that are bent, and from nearer than a few
/// of a lamp's own discs. Sums over a lamp are those of its discs, far ones together: the error is below 1e-3.
ShaftLight light_through_shafts(View<Splat> points, const DeviceLighting& lighting);

/// Lamps, that is groups of emitting splats that lie apart from each other, and [[light]]s.
constexpr std::size_t most_lamps = 16;

} // namespace pointgi
