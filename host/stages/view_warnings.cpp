#include "host/stages/view_warnings.h"
#include "host/lights/light_kind.h"
#include "host/run.h"
#include "host/scene/objects.h"
#include <algorithm>

namespace pointgi {

namespace {

std::string text(const Vector3d& p) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", p.x(), p.y(), p.z());
}

std::string place_of(const LightSettings& light) {
  return description_of(light) + (light.is_far ? " may meet backs, or something that stands before all else"
                                               : " may lie inside or behind something");
}

/// What may keep the light away, of the lights that the scene has: the first of each kind speaks for the others.
std::string suspects(const Scene& scene) {
  std::string list = "surfaces are lit, and shine, on the side of their normal only, unless two_sided";
  for (std::size_t i = 0; i < scene.clouds.size() + scene.shapes.size(); ++i) {
    const SceneObject object = object_of(scene, i);
    const auto is_its = [&](const MaterialSettings& m) { return m.name == object.material; };
    const auto material = std::find_if(scene.materials.begin(), scene.materials.end(), is_its);
    if (material->emission.maxCoeff() <= 0.0) continue;
    list += "; " + object.name + ", which shines, may face away from what it should light: " + object.how_to_turn;
    break;
  }
  if (!scene.lights.empty()) list += "; " + place_of(scene.lights.front());
  if (scene.sky != nullptr || scene.environment.maxCoeff() > 0.0)
    list += "; what surrounds all else keeps the light of the sky out";
  if (scene.render.max_depth)
    list += "; render.max_depth = " + std::to_string(*scene.render.max_depth) + " may leave out too much";
  return list;
}

/// A lamp of which little is left at the distance of the scene's half: "; the point light at ... gives ...".
std::string weak_lamp(const Scene& scene, const PreparedScene& ready) {
  const double reach = 0.5 * ready.frame.side;
  for (const LightSettings& light : scene.lights) {
    if (light.is_far) continue;
    const double irradiance = light.strength.maxCoeff() / (reach * reach);
    if (irradiance > 0.0 && irradiance < 0.1)
      return fmt::format(
          "; {} gives {:.2g} W/m2 across half of the scene, which is {:.4g} long, and about 3 would look "
          "bright: its power should be {:.2g} times as large",
          description_of(light), irradiance, ready.frame.side, 3.0 / irradiance);
  }
  return {};
}

bool is_dark(View<float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return !(v > 0.0f); });
}

/// The object whose backs were met most, and what to do.
std::string advice_on_backs(const RenderTotals& totals, const Scene& scene) {
  const auto fewer = [](const ObjectRays& a, const ObjectRays& b) { return a.on_backs < b.on_backs; };
  const auto most = std::max_element(totals.of_object.begin(), totals.of_object.end(), fewer);
  if (most == totals.of_object.end() || most->on_backs == 0) return "parts of surfaces face away from the camera";
  const SceneObject object = object_of(scene, static_cast<std::size_t>(most - totals.of_object.begin()));
  const std::string whose = "most are of " + object.name;
  if (most->on_backs > most->on_splats / 2)
    return whose + ", which faces the other way (" + object.how_to_turn + "), or the camera stands inside or behind it";
  if (object.is_cloud)
    return whose + ", parts of which face away from the camera; where they should not, normals = \"estimate\" may find "
                   "better ones";
  return whose + ", parts of which face away from the camera; where they should not: " + object.how_to_turn;
}

} // namespace

bool warn_of_paths(const std::string& list, const Scene& scene, const PreparedScene& ready) {
  const DeviceLighting& lighting = ready.lighting;
  const PathSupply supply{has_reflectors(scene, ready.points), lighting.has_specular(),
                          lighting.has_flag(MATERIAL_HAS_LOBE), !lighting.emitters.empty() || lighting.has_environment,
                          !lighting.light_sources.empty()};
  const std::string reason = why_no_path(list, scene.render.max_depth, supply);
  if (reason.empty()) return false;
  log_warning("the picture will be black: {}none of the light paths that count can be in this scene: {}",
              list.empty() ? "" : "--paths " + list + ": ", reason);
  return true;
}

bool warn_of_unlit(const Scene& scene, const PreparedScene& ready, View<float> direct, View<float> from_surfaces) {
  if (!ready.lighting.has_light() || ready.lighting.has_specular() || direct.size == 0) return false;
  if (!is_dark(direct) || !is_dark(from_surfaces)) return false;
  log_warning("no light reaches any surface: {}", suspects(scene));
  return true;
}

void warn_of_exposure(const PngLight& shown, const Scene& scene, const PreparedScene& ready) {
  constexpr double burnt = 0.9, dark = 0.02;
  if (shown.clipped_share > burnt)
    log_warning("{:.0f} % of the PNG's pixels are burnt to white at an exposure of {:.4g}: --exposure auto chooses a "
                "lower one (daylight wants about -8), or less light",
                100.0 * shown.clipped_share, shown.exposure);
  else if (shown.mean < dark && shown.lit_share > 0.05)
    log_warning(
        "the PNG is nearly black at an exposure of {:.4g}, though {:.0f} % of its pixels receive light: --exposure "
        "auto chooses a higher one{}",
        shown.exposure, 100.0 * shown.lit_share, weak_lamp(scene, ready));
}

void warn_of_view(const RenderTotals& totals, const Scene& scene, const PreparedScene& ready, bool already_warned) {
  if (totals.eye_rays_on_splats == 0 && !totals.interrupted && totals.eye_rays > 0) {
    const Vector3d& low = ready.frame.origin;
    log_warning("no eye ray met a splat: the splats lie within {} and {}, the camera is at {}; are the units the same, "
                "and does it look that way?",
                text(low), text(low + Vector3d::Constant(ready.frame.side)), text(scene.camera.position));
    return;
  }
  const double backs = totals.back_face_share();
  if (backs > 0.1)
    log_warning("{:.0f} % of the eye rays that hit a splat met its back, which is black: {}", 100.0 * backs,
                advice_on_backs(totals, scene));
  if (totals.lit || totals.interrupted || already_warned || !ready.lighting.has_light()) return;
  if (totals.eye_rays_on_back_faces == totals.eye_rays_on_splats) return; // said above
  const bool reflects = has_reflectors(scene, ready.points) || ready.lighting.has_specular();
  log_warning("the picture is all black: {}", reflects ? "no light reaches what the camera sees: " + suspects(scene)
                                                       : "nothing reflects light: give a material an albedo above 0");
}

} // namespace pointgi
