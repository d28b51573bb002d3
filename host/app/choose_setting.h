#pragma once
/// Which setting --time and --error ask for, and what a picture will take and be, known before it begins.
#include "host/app/commands.h"
#include "host/app/grow_picture.h"
#include "host/measure/trade.h"

namespace pointgi {

struct ChosenSetting {
  std::vector<std::string> overrides; ///< of the scene's settings, but for render.spp
  PictureGoal goal;
  double seconds = 0.0, error = 0.0; ///< expected, from the prepared cloud on
  std::string told;                  ///< what it is, and why, in a sentence
};

/// What was measured of the scene: --trade's, else what is kept of it on this device; absent, which the log hears,
/// where its files have changed since or the command's settings are others, but for those of [render]. Throws
/// Error(input) for a --trade that cannot be read.
std::optional<Trade> trade_for(const RenderOptions& options, const std::string& device);

/// By the trade, for `pixels` pixels; `begun`: seconds that the command has taken already. Absent: the trade has no
/// settings.
std::optional<ChosenSetting> choose_by_trade(const Trade& trade, const RenderOptions& options, double pixels,
                                             double begun);

/// Where the scene was not measured: by the presets, and what they reached on scenes of its kind. `light_seconds`: of
/// the light by the scene's own settings, as far as they are known.
struct PresetChoice {
  std::string preset;
  ChosenSetting setting;
};
PresetChoice choose_by_presets(const std::string& kind, const RenderOptions& options, double light_seconds,
                               double begun);

/// relMSE that a preset reached on scenes of a kind, from the least to the greatest; absent: it was measured on none.
std::optional<std::pair<double, double>> errors_of_kind(const std::string& preset, const std::string& kind);

/// What the trade says of a picture by `overrides`, none of them render.spp, of `samples` samples a pixel; absent: it
/// was not measured.
std::optional<ChosenSetting> forecast_of(const Trade& trade, const std::vector<std::string>& overrides, int samples,
                                         double pixels);

} // namespace pointgi
