#pragma once
/// Light that diffuse surfaces send each other, solved once for all views: V-map and FMM radiosity (method.md §3, §4).
#include "fmm/lists/interaction_lists.h"
#include "fmm/solve/solve.h"
#include "host/passes/device_pools.h"
#include "host/scene/lighting.h"
#include "octree/vmap/make_links.h"

#include <functional>

namespace pointgi {

/// Told now and then what is done so far, "12 million rays".
using WorkReport = std::function<void(const std::string&)>;

/// What light is exchanged in.
struct ExchangeScene {
  const DevicePools& pools;
  const TraversalVariant& variant;
  View<Splat> points;           ///< of the pool: all of them block light
  View<std::uint8_t> exchanges; ///< of each material: whether its splats send and receive diffuse light; empty: all do
  double side = 1.0;            ///< of the root cube, world units
  unsigned seed = 1;
};

/// Who sees whom, among the points that exchange light.
struct RadiosityMap {
  ClusterTree tree;
  std::vector<std::uint32_t> place; ///< in the pool, of each point in the tree's order
  VMap vmap;
  bool kept = false; ///< from an earlier run: nothing was asked
};

/// Builds the clusters and asks the device for their visibility; where no splat exchanges light, asks nothing. Throws
/// Error(device), Error(memory).
RadiosityMap map_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                            const WorkReport& report);

/// Light that enters the exchange, of all points of the pool; W/m² divided by the lighting's scale.
struct EnteringLight {
  View<float> direct; ///< [points x 3]: irradiance by lights (point_irradiance.h)
  View<float>
      emitted; ///< [points x 3]: radiosity that they shine with themselves; empty: none, or in `direct` of others
};

/// The solution, per point of the pool.
struct RadiosityField {
  std::vector<float> irradiance; ///< [points x 3, W/m² divided by the lighting's scale]: from surfaces to surfaces,
                                 ///< LDD+; 0 of points that do not exchange light
  Solution solution;             ///< radiosity of those that do in the tree's order (directly: the pool's), residual
  ExchangeCounts counts;         ///< of an apply, by V-map and FMM
  std::uint64_t rays = 0;        ///< that decided who sees whom, now or in an earlier run
};

/// Solves B = E + rho (H_direct + H(B)) to settings.tolerance and gathers H(B) once more. Throws std::invalid_argument
/// on sizes that differ.
RadiosityField solve_radiosity_field(Session& session, const RadiosityMap& map, const EnteringLight& light,
                                     const RadiositySettings& settings, const WorkReport& report);

/// The same by the direct method: a ray a pair of points that exchange light, no V-map. Throws Error(memory) for more
/// points than the device can keep a bit a pair of (host/radiosity/direct.h).
RadiosityField solve_radiosity_directly(Session& session, const ExchangeScene& scene, const EnteringLight& light,
                                        const RadiositySettings& settings, const WorkReport& report);

} // namespace pointgi
