#include "host/scene/presets.h"
#include "host/error.h"
#include "host/scene/limits.h"
#include "host/scene/toml_reader.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace pointgi {

namespace {

constexpr limits::NumberRange factor{0.0, 1e6, true, false, "above 0"};
constexpr limits::NumberRange figure{-1e6, 1e9, false, false, "that was measured"};

toml::table file_named(const std::string& name) {
  for (const EmbeddedFile& file : preset_files())
    if (file.name == name) return toml::parse(file.text);
  throw Error(ErrorKind::internal, name + " is not in the program");
}

std::vector<Preset> read_presets() {
  const std::string name = "presets.toml";
  const toml::table document = file_named(name);
  std::vector<Preset> all;
  for (const TableReader& row : TableReader(document, name, "").tables("preset")) {
    row.allow_only({"name", "samples", "epsilon", "directions", "point_light_samples", "error"});
    all.push_back({row.need_text("name", "a name"), row.need_number("samples", factor),
                   row.need_number("epsilon", factor), row.need_number("directions", factor),
                   static_cast<int>(row.need_number("point_light_samples", factor)), row.need_number("error", factor)});
  }
  return all;
}

std::map<std::string, double> read_least_errors() {
  const std::string name = "presets.toml";
  const toml::table document = file_named(name);
  std::map<std::string, double> all;
  for (const TableReader& row : TableReader(document, name, "").tables("least")) {
    row.allow_only({"kind", "error"});
    all[row.need_text("kind", "a kind")] = row.need_number("error", factor);
  }
  return all;
}

std::vector<PresetMeasurement> read_measurements() {
  const std::string name = "measured.toml";
  const toml::table document = file_named(name);
  std::vector<PresetMeasurement> all;
  for (const TableReader& row : TableReader(document, name, "").tables("measured")) {
    row.allow_only({"preset", "scene", "kind", "chosen_by", "error", "low", "high", "noise", "samples", "seconds"});
    all.push_back({row.need_text("preset", "a preset"), row.need_text("scene", "a name"),
                   row.need_text("kind", "a kind"), row.boolean("chosen_by").value_or(false),
                   row.need_number("error", figure), row.need_number("low", figure), row.need_number("high", figure),
                   row.need_number("noise", figure), static_cast<int>(row.need_number("samples", figure)),
                   row.need_number("seconds", figure)});
  }
  return all;
}

int scaled(int value, double by, limits::IntegerRange range) {
  const double most = std::max<double>(value, static_cast<double>(range.high));
  return static_cast<int>(std::clamp(std::round(value * by), static_cast<double>(range.low), most));
}

} // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = read_presets();
  return all;
}

const std::vector<PresetMeasurement>& preset_measurements() {
  static const std::vector<PresetMeasurement> all = read_measurements();
  return all;
}

double least_error(const std::string& kind) {
  static const std::map<std::string, double> all = read_least_errors();
  const auto least = all.find(kind);
  return least == all.end() ? 0.0 : least->second;
}

double promised_error(const Preset& preset, const std::string& kind) {
  return std::max(preset.error, least_error(kind));
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets())
    names.push_back(preset.name);
  return names;
}

const Preset& preset_named(const std::string& name, const std::string& what) {
  std::string list;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    list += fmt::format("{}\"{}\"", list.empty() ? "" : &preset == &presets().back() ? " or " : ", ", preset.name);
  }
  throw Error(ErrorKind::usage, what + ": expected " + list + ", found \"" + name + "\"");
}

void apply_preset(const Preset& preset, Scene& scene, bool samples_given) {
  if (!samples_given) scene.render.spp = scaled(scene.render.spp, preset.samples, limits::spp);
  RadiositySettings& radiosity = scene.radiosity;
  radiosity.directions = scaled(radiosity.directions, preset.directions, limits::directions);
  const double epsilon = preset.epsilon * radiosity.epsilon;
  radiosity.epsilon =
      preset.epsilon > 1.0 ? std::max(radiosity.epsilon, std::min(epsilon, limits::coarsest_draft_epsilon)) : epsilon;
}

void apply_bake_preset(const Preset& preset, Scene& scene) {
  apply_preset(preset, scene);
  if (!scene.radiosity.light_samples) scene.radiosity.light_samples = preset.point_light_samples;
}

std::vector<std::string> preset_overrides(const Preset& preset, const Scene& scene) {
  Scene changed = scene;
  apply_preset(preset, changed);
  std::vector<std::string> overrides;
  const std::string& method = scene.radiosity.method;
  const bool open = method == "auto";
  // Said, or a key would choose the method that reads it.
  if (open) overrides.push_back("radiosity.method=auto");
  if (changed.render.spp != scene.render.spp) overrides.push_back("render.spp=" + std::to_string(changed.render.spp));
  if ((open || method == "directions") && changed.radiosity.directions != scene.radiosity.directions)
    overrides.push_back("radiosity.directions=" + std::to_string(changed.radiosity.directions));
  if ((open || method == "fmm") && changed.radiosity.epsilon != scene.radiosity.epsilon)
    overrides.push_back(fmt::format("radiosity.epsilon={:g}", changed.radiosity.epsilon));
  return overrides.size() == 1 && open ? std::vector<std::string>() : overrides;
}

} // namespace pointgi
