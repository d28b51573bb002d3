#pragma once
/// What the device's memory cannot hold is refused before the work, with the settings that would fit.
#include "host/stages/indirect_stages.h"
#include "host/stages/prepared_scene.h"

namespace pointgi {

/// The points of the octree, for texts that say how many fewer would fit.
struct ScenePoints {
  const Scene& scene;
  View<Splat> points;        ///< in the cube
  View<std::uint32_t> ids;   ///< PreparedScene::ids of these points
  View<std::uint32_t> first; ///< PreparedScene::first_ids
  double side = 1.0;         ///< of the cube, world units
};

/// "cloud.0.voxel = 0.02, which keeps about 4000 points" or "shape.1.spacing = 0.1, ...": of the object with the most
/// points, so that about `share` (above 0, at most 1) of all points are left. Empty without points.
std::string fewer_points(const ScenePoints& points, double share);

/// The octree, before it goes to the device. Throws Error(memory).
void require_pool_memory(const Session& session, const ScenePoints& points, const OctreeSummary& octree,
                         const TraversalVariant& variant);

/// The light of the scene on the device: the method's stage where the scene names it, and photons where `photons`.
/// Closed forms alone (host/stages/device_need.h), of the least: "directions" without kept hits, and half of the
/// photons, as the others may end on no surface. Throws Error(memory).
void require_light_memory(const Session& session, const IndirectRequest& request, const ScenePoints& points,
                          bool photons);

/// The stage `fmm`, as soon as its links are told. Throws Error(memory).
void require_fmm_memory(const Session& session, const ClusterTree& tree, const RadiositySettings& settings,
                        const LinkEstimate& links);

} // namespace pointgi
