#include "host/app/light_command.h"
#include "host/scene/limits.h"
#include <charconv>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Refused under the name that it was given by, not as the --set that it becomes.
std::string checked_exposure(const std::string& text) {
  if (text == "auto") return "\"auto\"";
  const limits::NumberRange& range = limits::exposure;
  double stops = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), stops);
  if (error != std::errc{} || end != text.data() + text.size() || !(stops >= range.low && stops <= range.high))
    throw Error(ErrorKind::usage,
                std::string("--exposure: expected \"auto\" or a number ") + range.words + ", found \"" + text + "\"");
  return fmt::format("{:#}", stops); // "2.0": a TOML number
}

} // namespace

std::vector<std::string> overrides_of(const LightOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back("render.seed=" + std::to_string(*options.seed));
  if (!options.exposure.empty()) overrides.push_back("render.exposure=" + checked_exposure(options.exposure));
  if (!options.up.empty()) overrides.push_back("up=\"" + options.up + '"');
  if (!options.ground.empty()) overrides.push_back("ground=\"" + options.ground + '"');
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
  stats.octree = prepared.ready.octree;
  stats.session = &prepared.context->session;
  stats.indirect = &light.light.indirect;
  stats.variant = prepared.ready.choice;
  stats.seconds = prepared.context->stages.seconds();
  return stats;
}

} // namespace pointgi
