#include "host/app/indirect_stages.h"
#include "host/cloud/normal_field.h"
#include "host/error.h"
#include "host/passes/point_irradiance.h"
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Estimates of the direct light of each point. Lights that are points or far away need one, since nothing of them is
/// chosen at random while they are few; what other estimates scatter, the many senders of a receiver average out.
constexpr unsigned light_samples = 16, sure_lights = 4;

unsigned samples_for(const DeviceLighting& lighting) {
  const bool sure = lighting.emitters.empty() && !lighting.has_environment && lighting.delta.size() <= sure_lights;
  return sure ? 1 : light_samples;
}

/// Empty when vmap and fmm run.
std::string reason_against(const Scene& scene, const DeviceLighting& lighting, bool by_paths) {
  if (lighting.delta.empty() && lighting.emitters.empty() && !lighting.has_environment)
    return "the scene has no light and no emission";
  if (by_paths) return "paths are traced";
  if (!scene.radiosity.place) return "the scene has no [radiosity]";
  return {};
}

Buffer<cl_float4> upload_field(Session& session, const std::vector<float>& irradiance) {
  std::vector<cl_float4> texels(irradiance.size() / 3);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = {{irradiance[3 * i], irradiance[3 * i + 1], irradiance[3 * i + 2], 0.0f}};
  return session.upload(texels);
}

} // namespace

void require_known_radiosity(const Scene& scene) {
  if (!scene.radiosity.place) return;
  const auto refuse = [&](const std::string& what) {
    throw Error(ExitCode::input, scene.radiosity.place->text() + ": [radiosity] " + what);
  };
  if (scene.radiosity.method != "fmm")
    refuse("method = \"" + scene.radiosity.method + "\" is not in this version; it has \"fmm\"");
  if (scene.radiosity.direct_light != "shadow_rays")
    refuse("direct_light = \"" + scene.radiosity.direct_light + "\" is not in this version; it has \"shadow_rays\"");
}

std::optional<Buffer<cl_float4>> normal_field_of(Session& session, const DeviceLighting& lighting, View<Splat> points,
                                                 StageLog& stages) {
  if (!lighting.has_specular()) {
    stages.skip("normals", "no specular material");
    return std::nullopt;
  }
  stages.start("normals");
  const auto slopes = fit_normal_field(points, [&](const Splat& splat) {
    return lighting.materials[static_cast<std::size_t>(splat.material)].type != MATERIAL_DIFFUSE;
  });
  std::vector<cl_float4> texels(slopes.size());
  for (std::size_t i = 0; i < slopes.size(); ++i)
    std::copy_n(slopes[i].slope, 4, texels[i].s);
  Buffer<cl_float4> field = session.upload(texels);
  stages.finish(slopes.size(), "points");
  return field;
}

IndirectLight run_indirect_stages(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                  const Scene& scene, const Frame& frame, const DeviceLighting& lighting,
                                  View<Splat> points, bool by_paths, StageLog& stages,
                                  const std::function<bool()>& stop) {
  IndirectLight light;
  const std::string reason = reason_against(scene, lighting, by_paths);
  if (!reason.empty()) {
    if (scene.radiosity.place) spdlog::warn("{}: [radiosity] has no effect: {}", scene.radiosity.place->text(), reason);
    stages.skip("vmap", reason);
    stages.skip("fmm", reason);
    return light;
  }
  stages.start("vmap");
  const RadiosityMap map =
      map_visibility(session, pools, variant, points, scene.radiosity, scene.render.seed, frame.side);
  light.links = map.vmap.statistics;
  if (map.kept) spdlog::info("V-map: kept from an earlier run");
  stages.finish(map.vmap.links.size(), "links");
  stages.start("fmm");
  const Buffer<float> direct = direct_irradiance_of_points(session, pools, variant, lighting, frame.side, points.size,
                                                           samples_for(lighting), true, stop);
  if (stop()) throw Error(ExitCode::interrupted, "interrupted before the radiosity was solved; nothing was written");
  RadiosityField field =
      solve_radiosity_field(session, map, session.download(direct, 3 * points.size), scene.radiosity);
  light.irradiance = upload_field(session, field.irradiance);
  light.solution = std::move(field.solution);
  stages.finish(points.size, "points");
  spdlog::info("radiosity: {} links, {} applies of the operator, residual {:.2g}", map.vmap.links.size(),
               light.solution.applies, light.solution.residual);
  if (const std::string complaint = complaint_of(light.solution); !complaint.empty())
    spdlog::warn("radiosity: {}", complaint);
  return light;
}

} // namespace pointgi
