#pragma once
/// What the commands share that compute light: render and bake.
#include "host/api/parts.h"
#include "host/app/commands.h"
#include "host/app/stats.h"

namespace pointgi {

/// The flags that both have, as overrides of the scene file: one place checks both.
std::vector<std::string> overrides_of(const LightOptions& options);

/// Besides, those of a picture. Throws Error(usage).
std::vector<std::string> picture_overrides_of(const RenderOptions& options);

/// The device that the flags ask for, which the log names; the stages that have begun before go on in it.
api::Context open_context(const LightOptions& options, StageLog&& begun, const RunControl& run);

/// What both have to say of a run until now; `light` must live as long.
Stats stats_of(const api::Light::Parts& light);

} // namespace pointgi
