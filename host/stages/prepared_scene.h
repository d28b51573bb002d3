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
  DeviceLighting lighting;
};

/// The stages `cloud` and `octree`: loads and places, chooses a view and a variant where the scene leaves them open,
/// builds, uploads. `bare`: the scene stands around a bare cloud. Throws what these do.
PreparedScene prepare_scene(Session& session, Scene& scene, bool bare, StageLog& stages);

/// --quality, a picture's noise and the exchange's error together: "draft" is a quarter of the scene's samples a pixel,
/// unless `samples_given` with the command, and four times its radiosity.epsilon, but no more than
/// limits::coarsest_draft_epsilon, and half of radiosity.directions; "high" four times, half, and twice.
void apply_quality(const std::string& quality, Scene& scene, bool samples_given = false);

/// --quality of a lit cloud, which shows the direct light of its points: besides, radiosity.light_samples is 16, 64 or
/// 256 where the scene leaves it open.
void apply_bake_quality(const std::string& quality, Scene& scene);

} // namespace pointgi
