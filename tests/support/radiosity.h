#pragma once
/// Light between surfaces by a method of the registry, without a scene file.
#include "host/radiosity/method.h"

namespace pointgi::test {

/// Ready to solve, by the method that `settings` names; the V-map is made where the method needs it.
inline std::unique_ptr<PreparedRadiosity> prepare_radiosity(Session& session, const ExchangeScene& scene,
                                                            const RadiositySettings& settings) {
  const WorkReport quiet = [](const std::string&) {};
  const RadiosityMethod& method = *radiosity_method(settings.method);
  std::optional<RadiosityMap> map;
  if (method.without_vmap == nullptr) map = map_visibility(session, scene, settings, quiet);
  return method.prepare(session, scene, settings, std::move(map), quiet);
}

} // namespace pointgi::test
