#include "host/measure/knobs.h"
#include "host/error.h"
#include "host/scene/nearest.h"
#include "host/scene/presets.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace pointgi {

namespace {

/// Rays beyond which all points are not asked for all others: minutes on any device of today.
constexpr double most_rays_of_pairs = 1e9;

enum class Needs {
  nothing,
  exchange, ///< light between surfaces
  photons,  ///< specular surfaces, and photons
  lights    ///< lamps or sky whose light a point has to estimate
};

/// A row of the table: see Knob.
struct Row {
  const char* key;
  const char* method; ///< radiosity.method that alone reads it; "": any
  Needs needs;
  bool falls;
  const char* theory;
  std::vector<const char*> values;
  std::string (*own)(const Scene&);
  std::vector<const char*> with = {}; ///< overrides that go with every value
};

/// --quality, whose values stand for several keys.
constexpr const char* quality_name = "quality";

std::string number(double value) {
  return fmt::format("{:g}", value);
}

template <typename T>
std::string word_or_open(const std::optional<T>& value) {
  return value ? std::string(name_of(*value)) : std::string();
}

const std::vector<Row>& rows() {
  constexpr bool falls = true, may_rise = false;
  static const std::vector<Row> all{
      {"render.spp",
       "",
       Needs::nothing,
       falls,
       "The noise of pixels falls as 1 over the samples.",
       {"2", "8", "32", "128"},
       [](const Scene& s) { return std::to_string(s.render.spp); }},
      {"radiosity.method",
       "",
       Needs::exchange,
       may_rise,
       "Methods differ in kind: which is the more accurate depends on the scene.",
       {"none", "cones", "fmm", "directions", "gather"},
       [](const Scene& s) { return s.radiosity.method; }},
      {"radiosity.directions",
       "directions",
       Needs::exchange,
       falls,
       "The noise of a point's light falls as 1 over its rays.",
       {"32", "128", "512", "2048"},
       [](const Scene& s) { return std::to_string(s.radiosity.directions); }},
      {"radiosity.epsilon",
       "fmm",
       Needs::exchange,
       falls,
       "Smaller clusters are divided where their light matters less.",
       {"0.08", "0.02", "0.005", "0.00125"},
       [](const Scene& s) { return number(s.radiosity.epsilon); }},
      {"radiosity.order",
       "fmm",
       Needs::exchange,
       falls,
       "The error of an expansion falls with its order.",
       {"2", "3", "4", "5"},
       [](const Scene& s) { return std::to_string(s.radiosity.order); }},
      {"radiosity.vmap_samples",
       "fmm",
       Needs::exchange,
       falls,
       "The noise of a share of visibility falls as 1 over the segments tried.",
       {"1", "2", "8", "32"},
       [](const Scene& s) { return std::to_string(s.radiosity.vmap_samples); }},
      {"radiosity.point_samples",
       "fmm",
       Needs::exchange,
       falls,
       "Points ask for themselves instead of sharing the answers of their cluster.",
       {"0", "128", "1024"},
       [](const Scene& s) { return std::to_string(s.radiosity.point_samples); }},
      {"radiosity.tolerance",
       "",
       Needs::exchange,
       falls,
       "Later bounces are left out by less.",
       {"0.1", "0.01", "0.001", "0.0001"},
       [](const Scene& s) { return number(s.radiosity.tolerance); }},
      {"radiosity.sampling",
       "gather",
       Needs::exchange,
       may_rise,
       "Windows of senders are drawn or averaged in other ways.",
       {"static", "monte_carlo", "mipmap", "adaptive", "all"},
       [](const Scene& s) { return s.radiosity.sampling; }},
      {"radiosity.window",
       "gather",
       Needs::exchange,
       falls,
       "A smaller window stands for fewer senders.",
       {"1024", "256", "64"},
       [](const Scene& s) { return s.radiosity.sampling == "mipmap" ? std::to_string(s.radiosity.window) : ""; },
       {"radiosity.sampling=mipmap"}},
      {"radiosity.cones",
       "cones",
       Needs::exchange,
       falls,
       "Narrower cones average less.",
       {"1", "6", "9", "16"},
       [](const Scene& s) { return std::to_string(s.radiosity.cones); }},
      {"radiosity.voxels",
       "cones",
       Needs::exchange,
       falls,
       "Smaller voxels average less.",
       {"32", "64", "128"},
       [](const Scene& s) { return std::to_string(s.radiosity.voxels); }},
      {"radiosity.light_samples",
       "",
       Needs::lights,
       falls,
       "The noise of a point's direct light falls as 1 over its estimates.",
       {"1", "4", "16", "64"},
       [](const Scene& s) { return s.radiosity.light_samples ? std::to_string(*s.radiosity.light_samples) : "16"; }},
      {"radiosity.direct_light",
       "",
       Needs::exchange,
       falls,
       "Shadows are as sharp as pixels and no longer as points.",
       {"radiosity", "auto"},
       [](const Scene& s) { return s.radiosity.direct_light; }},
      {"caustics.photons",
       "",
       Needs::photons,
       falls,
       "More photons lie closer together: less noise and less blur.",
       {"25000", "100000", "400000", "1600000"},
       [](const Scene& s) { return std::to_string(s.caustics.photons); }},
      {"caustics.gather_k",
       "",
       Needs::photons,
       may_rise,
       "More photons taken together are less noise and more blur.",
       {"10", "50", "200", "800"},
       [](const Scene& s) { return std::to_string(s.caustics.gather_k); }},
      {"caustics.power",
       "",
       Needs::photons,
       may_rise,
       "Photons of equal power have less noise, and a bias where those of lamps and materials differ.",
       {"equal", "unbiased"},
       [](const Scene& s) { return s.caustics.power; }},
      {"traversal.surface",
       "",
       Needs::nothing,
       may_rise,
       "The surface is another one, and the reference keeps the scene's own.",
       {"discs", "mls"},
       [](const Scene& s) { return std::string(name_of(s.traversal.surface)); }},
      {"traversal.form",
       "",
       Needs::nothing,
       may_rise,
       "The picture is the same to within rounding.",
       {"wide", "step"},
       [](const Scene& s) { return word_or_open(s.traversal.form); }},
      {"traversal.stepping",
       "",
       Needs::nothing,
       may_rise,
       "Steps of one length miss what is thinner.",
       {"absolute_delta", "exact"},
       [](const Scene& s) {
         return s.traversal.form == TraversalForm::step ? std::string(name_of(s.traversal.stepping)) : std::string();
       },
       {"traversal.form=step"}},
      {"octree.leaf_capacity",
       "",
       Needs::nothing,
       may_rise,
       "The picture is the same to within rounding.",
       {"32", "64", "128"},
       [](const Scene& s) { return s.octree.leaf_capacity ? std::to_string(*s.octree.leaf_capacity) : ""; }},
      {"traversal.fast_math",
       "",
       Needs::nothing,
       may_rise,
       "Rounding is looser, far below other errors where the result is right.",
       {"true", "false"},
       [](const Scene& s) { return std::string(s.traversal.fast_math ? "true" : "false"); }},
  };
  return all;
}

Knob quality_knob(const Scene& scene) {
  Knob knob{quality_name, quality_name, true, "Samples and the light's settings grow together.", {}};
  knob.is_of_several_keys = true;
  for (const Preset& preset : presets()) {
    const std::vector<std::string> overrides = preset_overrides(preset, scene);
    knob.values.push_back({preset.name, overrides, overrides.empty(), overrides.empty()});
  }
  return knob;
}

std::string name_of_key(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

bool has_specular(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const MaterialSettings& m) { return (m.flags & MATERIAL_SPECULAR) != 0; });
}

/// Light that one estimate a point does not give exactly.
bool has_estimated_light(const Scene& scene) {
  const auto is_exact = [](const LightSettings& light) { return light.sky == nullptr && light.sine2 == 0.0; };
  return scene.sky != nullptr || !scene.environment.isZero() || scene.lights.size() > 4 ||
         !std::all_of(scene.lights.begin(), scene.lights.end(), is_exact) ||
         std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const MaterialSettings& m) { return !m.emission.isZero(); });
}

std::string reason_against(const Row& row, const KnobScene& of) {
  switch (row.needs) {
  case Needs::nothing:
    return {};
  case Needs::exchange:
    return of.method == "none" ? "left out: no light is exchanged between this scene's surfaces" : "";
  case Needs::photons:
    if (!has_specular(of.scene)) return "left out: no material of the scene is specular";
    return of.scene.caustics.photons == 0 ? "left out: caustics.photons is 0" : "";
  case Needs::lights:
    return has_estimated_light(of.scene) ? "" : "left out: one estimate gives the light of these lamps exactly";
  }
  return {};
}

/// Whether the value would have every point ask every other.
bool asks_pairs(const std::string& key, const std::string& value) {
  return key == "radiosity.sampling" && value == "all";
}

/// Direct light that is computed at the points needs an exchange.
bool is_impossible(const std::string& key, const std::string& value, const Scene& scene) {
  return key == method_key && value == "none" && scene.radiosity.direct_light == "radiosity";
}

KnobValue value_of(const Row& row, const std::string& text, const KnobScene& of) {
  const std::string key = row.key, method = row.method;
  KnobValue value{text, {}, false};
  const double pairs = 0.5 * static_cast<double>(of.points) * static_cast<double>(of.points);
  // "auto" takes time to choose, and might choose otherwise where a key differs.
  value.own = text == row.own(of.scene) && (method.empty() || method == of.scene.radiosity.method);
  value.in_scene =
      key == method_key ? text == of.method : text == row.own(of.scene) && (method.empty() || method == of.method);
  if (!method.empty() && method != of.scene.radiosity.method) value.overrides.push_back("radiosity.method=" + method);
  for (const char* with : row.with)
    value.overrides.emplace_back(with);
  value.overrides.push_back(key + "=" + text);
  if (key == method_key && text == "gather" && pairs > most_rays_of_pairs)
    value.overrides.emplace_back("radiosity.sampling=mipmap");
  return value;
}

/// Those of the row and, where they are numbers, the scene's own in its place among them: a curve shows where the scene
/// stands on it, and other settings can be foretold from there.
std::vector<std::string> values_of(const Row& row, const KnobScene& of) {
  std::vector<std::string> values(row.values.begin(), row.values.end());
  const std::string own = row.own(of.scene), method = row.method;
  const bool is_read = method.empty() || method == of.method;
  if (!is_read || !is_number(own) || !std::all_of(values.begin(), values.end(), is_number)) return values;
  const bool rising = std::stod(values.front()) < std::stod(values.back());
  const auto at = std::find_if(values.begin(), values.end(), [&](const std::string& value) {
    return rising ? std::stod(value) >= std::stod(own) : std::stod(value) <= std::stod(own);
  });
  if (at == values.end() || std::stod(*at) != std::stod(own)) values.insert(at, own);
  return values;
}

Knob knob_of(const Row& row, const KnobScene& of) {
  Knob knob{name_of_key(row.key), row.key, row.falls, row.theory, {}, reason_against(row, of), row.method};
  const double pairs = 0.5 * static_cast<double>(of.points) * static_cast<double>(of.points);
  knob.of_exchange = row.needs == Needs::exchange && knob.key != method_key;
  if (knob.left_out.empty())
    for (const std::string& text : values_of(row, of))
      if ((!asks_pairs(row.key, text) || pairs <= most_rays_of_pairs) && !is_impossible(row.key, text, of.scene))
        knob.values.push_back(value_of(row, text, of));
  return knob;
}

} // namespace

bool is_number(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return !value.empty() && *end == '\0' && std::isfinite(number) && number >= 0.0;
}

std::vector<Knob> knobs_of(const KnobScene& scene) {
  std::vector<Knob> knobs{quality_knob(scene.scene)};
  for (const Row& row : rows())
    knobs.push_back(knob_of(row, scene));
  return knobs;
}

std::vector<std::string> knob_names() {
  std::vector<std::string> names{quality_name};
  for (const Row& row : rows())
    names.push_back(name_of_key(row.key));
  return names;
}

std::string checked_knob(const std::string& name_or_key) {
  std::vector<std::string> known = knob_names();
  std::string list;
  for (const std::string& name : known)
    list += (list.empty() ? "" : ", ") + name;
  for (const Row& row : rows())
    known.emplace_back(row.key);
  if (std::find(known.begin(), known.end(), name_or_key) != known.end()) return name_of_key(name_or_key);
  const std::string near = nearest(name_or_key, known);
  throw Error(ErrorKind::usage, "--knobs: there is no knob \"" + name_or_key + "\"" +
                                    (near.empty() ? "" : "; did you mean \"" + near + "\"?") +
                                    "; the knobs are: " + list);
}

} // namespace pointgi
