#include "host/app/commands.h"

namespace pointgi {

std::vector<std::string> overrides_of(const LightOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back("render.seed=" + std::to_string(*options.seed));
  if (options.exposure) overrides.push_back("render.exposure=" + std::to_string(*options.exposure));
  return overrides;
}

} // namespace pointgi
