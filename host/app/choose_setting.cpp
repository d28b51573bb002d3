#include "host/app/choose_setting.h"
#include "host/app/progress.h"
#include "host/measure/forecast.h"
#include "host/measure/measure.h"
#include "host/measure/stored_trade.h"
#include "host/scene/presets.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

namespace fs = std::filesystem;

std::string key_of(const std::string& override_text) {
  return override_text.substr(0, override_text.find('='));
}

bool touches(const LightChoice& light, const std::vector<std::string>& own) {
  return std::any_of(light.overrides.begin(), light.overrides.end(), [&](const std::string& text) {
    return std::any_of(own.begin(), own.end(), [&](const std::string& other) { return key_of(other) == key_of(text); });
  });
}

/// The picture's first version and the files take this share of --time.
constexpr double share_of_rest = 0.12;

std::string settings_text(const std::vector<std::string>& overrides) {
  std::string text;
  for (const std::string& one : overrides)
    text += (text.empty() ? "" : " ") + one;
  return text.empty() ? "the scene's own settings" : text;
}

ChosenSetting chosen_of(const PictureChoice& choice, double pixels, double factor, const RenderOptions& options) {
  ChosenSetting chosen;
  chosen.overrides = choice.light.overrides;
  chosen.seconds = choice.seconds;
  chosen.error = choice.error;
  PictureGoal& goal = chosen.goal;
  goal.samples = choice.samples;
  goal.until = options.seconds;
  goal.error = options.error;
  goal.light_error = std::max(0.0, choice.light.light_error.value);
  goal.noise_factor = factor;
  goal.seconds_a_sample = choice.light.seconds_a_sample * pixels;
  goal.noise_a_sample = choice.light.noise_a_sample;
  return chosen;
}

} // namespace

std::optional<Trade> trade_for(const RenderOptions& options, const std::string& device) {
  std::optional<Trade> trade;
  if (!options.trade.empty()) {
    std::error_code ignored;
    trade = read_trade(fs::is_directory(options.trade, ignored) ? (fs::path(options.trade) / trade_json_name).string()
                                                                : options.trade);
  } else {
    trade = stored_trade(options.input, device);
  }
  if (!trade) return std::nullopt;
  MeasureOptions measured;
  measured.scene = options.input;
  measured.overrides = trade->overrides;
  if (state_of(measured) == trade->state) return trade;
  if (options.seconds || options.error)
    spdlog::warn("{} has changed since it was measured; `pointgi measure {}` tells anew", options.input, options.input);
  return options.trade.empty() ? std::nullopt : trade;
}

std::optional<ChosenSetting> choose_by_trade(const Trade& trade, const RenderOptions& options,
                                             const std::vector<std::string>& own_overrides, double pixels,
                                             double begun) {
  std::vector<LightChoice> lights = light_choices(trade);
  lights.erase(std::remove_if(lights.begin(), lights.end(),
                              [&](const LightChoice& light) { return touches(light, own_overrides); }),
               lights.end());
  if (lights.empty()) return std::nullopt;
  const double for_picture =
      options.seconds ? (1.0 - share_of_rest) * *options.seconds - begun - trade.prepare_seconds : 0.0;
  std::optional<PictureChoice> choice;
  std::string doubt;
  if (options.error) {
    choice = choose_for_error(lights, pixels, *options.error);
    if (!choice)
      doubt = fmt::format("; no measured setting reaches {:.3g}", *options.error);
    else if (options.seconds && choice->seconds > for_picture) {
      doubt = fmt::format("; {:.3g} would take {}", *options.error, duration_text(choice->seconds));
      choice = std::nullopt;
    }
  }
  if (!choice && options.seconds) {
    choice = choose_for_time(lights, pixels, for_picture);
    if (!choice) doubt = "; no measured setting is so fast";
  }
  if (!choice) { // the most accurate where a time does not matter, else the fastest
    const auto least = [&](const auto& by) {
      return *std::min_element(lights.begin(), lights.end(),
                               [&](const LightChoice& a, const LightChoice& b) { return by(a) < by(b); });
    };
    const LightChoice light = options.seconds ? least([&](const LightChoice& l) { return seconds_of(l, pixels, 1); })
                                              : least([](const LightChoice& l) { return l.light_error.high; });
    const double allowed = options.error ? std::max(0.25 * *options.error, 1e-9) : 1.0;
    const int samples =
        options.seconds ? 1 : static_cast<int>(std::clamp(light.noise_a_sample / allowed, 32.0, 4096.0));
    choice = PictureChoice{light, samples, seconds_of(light, pixels, samples), error_of(light, samples)};
  }
  ChosenSetting chosen = chosen_of(*choice, pixels, noise_factor(trade), options);
  chosen.told = fmt::format("chosen by what was measured of it on {}: {}; expected: {}, relMSE {:.2g}{}", trade.date,
                            settings_text(chosen.overrides), duration_text(chosen.seconds), chosen.error, doubt);
  return chosen;
}

std::optional<std::pair<double, double>> errors_of_kind(const std::string& preset, const std::string& kind) {
  std::optional<std::pair<double, double>> range;
  for (const PresetMeasurement& m : preset_measurements()) {
    if (m.preset != preset || m.kind != kind) continue;
    if (!range) range.emplace(m.error, m.error);
    range = std::pair(std::min(range->first, m.error), std::max(range->second, m.error));
  }
  return range;
}

PresetChoice choose_by_presets(const std::string& kind, const RenderOptions& options, double light_seconds,
                               double begun) {
  // Of --time, as much for the light: more samples are wanted, too.
  constexpr double share_of_light = 0.4;
  const auto time_of = [&](const Preset& preset) { return light_seconds * preset.directions; };
  const double for_light = options.seconds ? share_of_light * (*options.seconds - begun) : 0.0;
  const Preset* chosen = nullptr;
  for (const Preset& preset : presets()) {
    const auto reached = errors_of_kind(preset.name, kind);
    const double error = reached ? reached->second : preset.error;
    if (options.seconds && chosen != nullptr && time_of(preset) > for_light) break;
    chosen = &preset;
    if (options.error && error <= *options.error) break;
  }
  PresetChoice choice;
  choice.preset = chosen->name;
  PictureGoal& goal = choice.setting.goal;
  goal.until = options.seconds;
  goal.error = options.error;
  for (const PresetMeasurement& m : preset_measurements())
    if (m.preset == chosen->name && m.kind == kind)
      goal.light_error = std::max(goal.light_error, m.error - m.noise / std::max(1, m.samples));
  choice.setting.told = fmt::format("--quality {} is chosen, as scenes of its kind ({}) need; `pointgi measure {}` would tell "
                                    "what this one does",
                                    chosen->name, kind, options.input);
  return choice;
}

std::optional<ChosenSetting> forecast_of(const Trade& trade, const std::vector<std::string>& overrides, int samples,
                                         double pixels) {
  std::vector<std::string> wanted = overrides;
  std::sort(wanted.begin(), wanted.end());
  for (const LightChoice& light : light_choices(trade)) {
    if (light.overrides != wanted) continue;
    ChosenSetting chosen;
    chosen.overrides = wanted;
    chosen.seconds = seconds_of(light, pixels, samples);
    chosen.error = error_of(light, samples);
    chosen.told = fmt::format("expected by what was measured of it on {}: {}, relMSE {:.2g}", trade.date,
                              duration_text(chosen.seconds), chosen.error);
    return chosen;
  }
  return std::nullopt;
}

} // namespace pointgi
