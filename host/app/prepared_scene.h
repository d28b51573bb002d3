#pragma once
/// From a scene's description to what the stages of light work on: the way that render and bake share.
#include "host/app/commands.h"
#include "host/app/prepare.h"
#include "host/app/stages.h"
#include "host/passes/device_pools.h"
#include "host/passes/tuned.h"
#include "host/scene/lighting.h"
#include "octree/pack/pools.h"

namespace pointgi {

/// A scene on the device.
struct PreparedScene {
  Frame frame;
  VariantChoice choice;
  OctreePools pools;
  DevicePools on_device;
  std::vector<std::uint32_t> ids; ///< of each point of the pool: its place among the kept points of the scene
  DeviceLighting lighting;
};

/// The stages `cloud` and `octree`: loads and places, chooses a view and a variant where the scene leaves them open,
/// builds, uploads. `bare`: the scene stands around a bare cloud. Throws what these do.
PreparedScene prepare_scene(Session& session, Scene& scene, bool bare, StageLog& stages);

/// The flags that every command that computes light has, as overrides of the scene file: one place checks both.
std::vector<std::string> overrides_of(const LightOptions& options);

} // namespace pointgi
