#pragma once
/// Light at points that see all of every lamp and [[light]]: by sums instead of shadow rays, without noise (Haines and
/// Wallace, "Shaft culling for efficient ray-traced radiosity", 1991, decides where; octree/vmap/shafts.h).
#include "host/scene/lighting.h"
#include "octree/vmap/shafts.h"
#include <memory>

namespace pointgi {

struct ShaftLight {
  std::vector<float> irradiance; ///< [points x 3], W/m² divided by the lighting's scale; an estimate by rays, if there
                                 ///< is any, where it is not known
  std::vector<float> change; ///< [points x 3]: gradient of the irradiance over itself along the disc, of all colours
                             ///< together [1 / root cube]; 0 where it is not known
  std::vector<std::uint8_t> known; ///< [points]: 1 where it is: each lamp and [[light]] shines on all of the disc, or
                                   ///< on none of it
  std::shared_ptr<const Shafts> shafts; ///< for add_light_by_rays(), which lets go of it; null: nothing was asked
  std::size_t known_points = 0;
};

/// `by_rays` [points x 3]: of every lamp and [[light]], an estimate for the points that know nothing, whose irradiance
/// it becomes. Where it is none, for all points of a leaf and for all that face alike within two radii about it, they
/// know that: no edge of a shadow runs over their discs.
void add_light_by_rays(View<float> by_rays, ShaftLight& light);

/// Of every [[light]] and all emitting splats together, not of the sky. `points`: the pool, discs. Nothing is known
/// where the scene has more lamps than shafts are worth (most_lamps), of lamps that are bent, and from nearer than a
/// few of a lamp's own discs. Sums over a lamp are those of its discs, far ones together: the error is below 1e-3.
ShaftLight light_through_shafts(View<Splat> points, const DeviceLighting& lighting);

/// Lamps, that is groups of emitting splats that lie apart from each other, and [[light]]s.
constexpr std::size_t most_lamps = 16;

} // namespace pointgi
