#pragma once
/// Who sees whom among the points that exchange light: the V-map (method.md §3), asked of the device or kept from an
/// earlier run.
#include "host/passes/device_pools.h"
#include "host/scene/scene.h"
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

/// Places in the pool of the points that send and receive light.
std::vector<std::uint32_t> exchanging_points(const ExchangeScene& scene);

/// The points at these places of the pool.
std::vector<Splat> points_at(const ExchangeScene& scene, View<std::uint32_t> places);

struct RadiosityMap {
  ClusterTree tree;
  std::vector<std::uint32_t> place; ///< in the pool, of each point in the tree's order
  VMap vmap;
  bool kept = false; ///< from an earlier run: its links were not asked for
};

/// The clusters of the points that exchange light, not yet asked for their visibility. Throws Error(device),
/// Error(memory).
RadiosityMap cluster_points(Session& session, const ExchangeScene& scene, const RadiositySettings& settings);

/// Rays after which find_visibility no longer divides what is far apart; 0: no bound. `points`: that exchange light.
std::uint64_t most_vmap_rays(const RadiositySettings& settings, std::size_t points);

/// What find_visibility would ask, from a sample of its questions; nothing where no splat exchanges light. Throws
/// Error(device), Error(memory).
LinkEstimate estimate_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                                 const RadiosityMap& clusters);

/// Asks the device for the visibility of the clusters; where no splat exchanges light, asks nothing. `expected`: what
/// it will ask, by which `report` is told how long it will take; absent: estimated where no map is kept. Throws
/// Error(device), Error(memory).
RadiosityMap find_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                             RadiosityMap clusters, std::optional<LinkEstimate> expected, const WorkReport& report);

/// All of it.
RadiosityMap map_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                            const WorkReport& report);

} // namespace pointgi
