#include "host/app/choose_setting.h"
#include "host/app/light_command.h"
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

/// The picture's first version and the files take this share of --time.
constexpr double share_of_rest = 0.12;

std::string settings_text(const std::vector<std::string>& overrides) {
  std::string text;
  for (const std::string& one : overrides)
    text += (text.empty() ? "" : " ") + one;
  return text.empty() ? "the scene's own settings" : text;
}

ChosenSetting chosen_of(const PictureChoice& choice, double pixels, const RenderOptions& options) {
  ChosenSetting chosen;
  chosen.overrides = choice.light.overrides;
  chosen.seconds = choice.seconds;
  chosen.error = choice.error;
  PictureGoal& goal = chosen.goal;
  goal.samples = choice.samples;
  goal.until = options.seconds;
  goal.error = options.error;
  goal.light_error = std::max(0.0, choice.light.light_error.value);
  goal.noise = choice.light.noise;
  goal.seconds_a_sample = choice.light.seconds_a_sample * pixels;
  goal.noise_a_sample = choice.light.noise_a_sample;
  return chosen;
}

/// Whether the scene's files are as they were.
bool is_of_state(const Trade& trade, const std::string& scene) {
  MeasureOptions measured;
  measured.scene = scene;
  measured.overrides = trade.overrides;
  measured.reference_file = trade.reference.file;
  try {
    return state_of(measured) == trade.state;
  } catch (const Error&) { // what the overrides name is no longer there
    return false;
  }
}

/// Whether the command asks for other settings of the scene than the measurement had; those of [render] do not count.
bool settings_besides(const RenderOptions& options, const Trade& trade) {
  const auto of_light = [](std::vector<std::string> all) {
    all.erase(std::remove_if(all.begin(), all.end(), [](const auto& text) { return text.rfind("render.", 0) == 0; }),
              all.end());
    std::sort(all.begin(), all.end());
    return all;
  };
  return of_light(overrides_of(options)) != of_light(trade.overrides);
}

} // namespace

std::optional<Trade> trade_for(const RenderOptions& options, const std::string& device) {
  const bool from_elsewhere = !options.trade.empty();
  std::optional<Trade> trade;
  if (from_elsewhere) {
    std::error_code ignored;
    trade = read_trade(fs::is_directory(options.trade, ignored) ? (fs::path(options.trade) / trade_json_name).string()
                                                                : options.trade);
    if (trade->device != device)
      spdlog::warn("{}: was measured on {}; the seconds may be others here", options.trade, trade->device);
  } else {
    trade = stored_trade(options.input, device);
  }
  if (!trade) return std::nullopt;
  const std::string unfit = !is_of_state(*trade, options.input) ? "has changed since it was measured"
                            : settings_besides(options, *trade) ? "was measured with other settings than --set asks for"
                                                                : "";
  if (unfit.empty()) return trade;
  if (options.seconds || options.error || from_elsewhere)
    spdlog::warn("{} {}; `pointgi measure` would tell anew", options.input, unfit);
  return std::nullopt;
}

std::optional<ChosenSetting> choose_by_trade(const Trade& trade, const RenderOptions& options, double pixels,
                                             double begun) {
  const std::vector<LightChoice> lights = light_choices(trade);
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
  if (!choice) { // the most accurate where a time does not matter, else the fastest; noise as of next_samples()
    const auto least = [&](const auto& by) {
      return *std::min_element(lights.begin(), lights.end(),
                               [&](const LightChoice& a, const LightChoice& b) { return by(a) < by(b); });
    };
    const LightChoice light = options.seconds ? least([&](const LightChoice& l) { return seconds_of(l, pixels, 1); })
                                              : least([](const LightChoice& l) { return l.light_error.high; });
    const double allowed = options.error ? std::max(0.25 * *options.error, 1e-9) : 1.0;
    const int samples =
        options.seconds
            ? 1
            : static_cast<int>(std::clamp(light.noise.samples(light.noise_a_sample, allowed), 1.0, 65536.0));
    choice = PictureChoice{light, samples, seconds_of(light, pixels, samples), error_of(light, samples)};
  }
  ChosenSetting chosen = chosen_of(*choice, pixels, options);
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
  if (range) range->second = std::max(range->second, least_error(kind));
  return range;
}

PresetChoice choose_by_presets(const std::string& kind, const RenderOptions& options, double light_seconds,
                               double begun) {
  // Of --time, as much for the light: more samples are wanted, too.
  constexpr double share_of_light = 0.4;
  // Of a preset's error: variances tell too much noise, as they know nothing of strata.
  constexpr double least_light = 0.25;
  const auto time_of = [&](const Preset& preset) { return light_seconds * preset.directions; };
  const double for_light = options.seconds ? share_of_light * (*options.seconds - begun) : 0.0;
  const Preset* chosen = nullptr;
  for (const Preset& preset : presets()) {
    const auto reached = errors_of_kind(preset.name, kind);
    const double error = reached ? reached->second : promised_error(preset, kind);
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
      goal.light_error =
          std::max({goal.light_error, m.error - m.noise / std::max(1, m.samples), least_light * m.error});
  goal.light_error = std::max(goal.light_error, least_error(kind));
  goal.light_error_known = errors_of_kind(chosen->name, kind).has_value();
  choice.setting.told = fmt::format("the settings of --quality {} are chosen, {}; `pointgi measure {}` would tell what "
                                    "this scene needs",
                                    chosen->name,
                                    goal.light_error_known ? "by what scenes of its kind (" + kind + ") needed"
                                                           : std::string("as no scene of its kind was measured"),
                                    options.input);
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
