#pragma once
/// From a scene's description to what the stages of light work on: the way that render and bake share.
#include "host/passes/device_pools.h"
#include "host/scene/lighting.h"
#include "host/stages/prepare.h"
#include "host/stages/stages.h"
#include "host/tune/tuned.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// A scene on the device.
struct PreparedScene {
  Frame frame;
  VariantChoice choice;
  OctreeSummary octree;
  Pool<OctreePoint> points; ///< the point pool
  DevicePools on_device;
  Pool<std::uint32_t> ids;              ///< of each point of the pool: its place among the kept points of the scene
  std::vector<std::uint32_t> first_ids; ///< id of the first point of each cloud, then of each shape
  std::optional<FileOrder> file_order;  ///< as of PlacedSplats
  std::vector<CloudKind> kinds;         ///< as of PlacedSplats
  DeviceLighting lighting;
};

/// The stages `cloud` and `octree`: loads and places, chooses a view and a variant where the scene leaves them open,
/// builds, uploads. `bare`: the scene stands around a bare cloud. Throws what these do.
PreparedScene prepare_scene(Session& session, Scene& scene, bool bare, StageLog& stages);

} // namespace pointgi
