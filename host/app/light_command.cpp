#include "host/app/light_command.h"
#include <spdlog/spdlog.h>

namespace pointgi {

std::vector<std::string> overrides_of(const LightOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back("render.seed=" + std::to_string(*options.seed));
  if (options.exposure) overrides.push_back("render.exposure=" + std::to_string(*options.exposure));
  return overrides;
}

api::Context open_context(const LightOptions& options, StageLog&& begun, const RunControl& run) {
  api::Context context(options.device, run);
  context.parts()->stages = std::move(begun);
  const DeviceInfo& info = context.parts()->session.info();
  spdlog::info("device: {} ({}, driver {})", info.name, info.platform, info.driver);
  return context;
}

Stats stats_of(const api::Light::Parts& light) {
  const api::Prepared::Parts& prepared = *light.prepared;
  Stats stats;
  stats.scene = &prepared.scene;
  stats.octree = summary_of(prepared.ready.pools);
  stats.session = &prepared.context->session;
  stats.indirect = &light.light.indirect;
  stats.variant = prepared.ready.choice;
  stats.seconds = prepared.context->stages.seconds();
  return stats;
}

} // namespace pointgi
