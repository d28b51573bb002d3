#pragma once
/// Light that diffuse surfaces send each other, solved once for all views: V-map and FMM radiosity (method.md §3, §4).
#include "fmm/solve/solve.h"
#include "host/passes/device_pools.h"
#include "host/scene/lighting.h"
#include "octree/vmap/make_links.h"

#include <functional>

namespace pointgi {

/// Told now and then what is done so far, "12 million rays".
using WorkReport = std::function<void(const std::string&)>;

/// Who sees whom, among the points of the pool.
struct RadiosityMap {
  ClusterTree tree; ///< over the pool's points: order[k] is a place in the pool
  VMap vmap;
  bool kept = false; ///< from an earlier run: nothing was asked
};

/// Builds the clusters and asks the device for their visibility. Throws Error(device), Error(memory).
RadiosityMap map_visibility(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                            View<Splat> points, const RadiositySettings& settings, unsigned seed, double side,
                            const WorkReport& report);

/// The solution, per point of the pool.
struct RadiosityField {
  std::vector<float>
      irradiance;    ///< [points x 3, W/m² divided by the lighting's scale]: from surfaces to surfaces, LDD+
  Solution solution; ///< radiosity in the tree's order, residual, sweeps
};

/// `direct` [points x 3]: what the lights give each point (point_irradiance.h), same unit. Solves B = rho (H_direct +
/// H(B)) to settings.tolerance and gathers H(B) once more. Throws std::invalid_argument on sizes that differ.
RadiosityField solve_radiosity_field(Session& session, const RadiosityMap& map, View<float> direct,
                                     const RadiositySettings& settings, const WorkReport& report);

} // namespace pointgi
