#include "host/api/parts.h"
#include "host/error.h"
#include "host/run.h"
#include "host/stages/lit_file.h"
#include "host/stages/require_memory.h"
#include "host/stages/view_warnings.h"
#include <filesystem>
#include <fmt/format.h>

namespace pointgi::api {

IndirectRequest Light::Parts::request() const {
  const PreparedScene& ready = prepared->ready;
  return {ready.choice.variant, prepared->scene, ready.frame, ready.lighting, prepared->points(), options.path_tracing};
}

const std::vector<float>& Light::Parts::sky_of_points() {
  constexpr int usual_light_samples = 64, rays_a_light_sample = 4; // a share scatters more than a sum of lights does
  if (!sky.empty()) return sky;
  Prepared::Parts& from = *prepared;
  StageLog& stages = from.context->stages;
  stages.start("sky");
  const int samples = from.scene.radiosity.light_samples.value_or(usual_light_samples);
  sky = pointgi::sky_of_points(from.context->session, from.ready.on_device, request(),
                               static_cast<unsigned>(rays_a_light_sample * samples));
  stages.finish(sky.size(), "points");
  return sky;
}

LitCloud Light::Parts::lit_cloud(const LitFileOptions& with) {
  if (with.sky && !prepared->ready.lighting.has_light()) {
    LitCloud points = bare_points(request());
    points.columns.push_back({"scalar_sky", sky_of_points()});
    return points;
  }
  if (options.path_tracing)
    throw Error(ErrorKind::usage, "light of path tracing holds no radiosity; solve the light without path_tracing");
  Prepared::Parts& from = *prepared;
  IndirectLight& indirect = light.indirect;
  if (indirect.direct.empty()) {
    log_warning("no light between surfaces: {}", reason_against_radiosity(request()));
    indirect.direct = direct_light_of_points(from.context->session, from.ready.on_device, request());
  }
  if (!warned_of_dark) warned_of_dark = warn_of_unlit(from.scene, from.ready, indirect.direct, indirect.from_surfaces);
  LitCloud lit = pointgi::lit_cloud(request(), indirect, with.exposure);
  if (with.sky) lit.columns.push_back({"scalar_sky", sky_of_points()});
  return lit;
}

namespace {

/// "LIT.pass-001.ply" of "LIT.ply".
std::string name_of_pass(const std::string& file, unsigned pass) {
  const std::filesystem::path path(file);
  return (path.parent_path() / fmt::format("{}.pass-{:03}{}", path.stem().string(), pass, path.extension().string()))
      .string();
}

} // namespace

void require_memory(const Prepared& prepared, const LightOptions& options) {
  Light::Parts light;
  light.prepared = prepared.parts();
  light.options = options;
  const Prepared::Parts& from = *prepared.parts();
  const PreparedScene& ready = from.ready;
  require_light_memory(from.context->session, light.request(),
                       {from.scene, ready.points, ready.ids, ready.first_ids, ready.frame.side}, options.photons);
}

Light::Light(const Prepared& prepared, const LightOptions& options, const RunControl& run) : parts_(new Parts) {
  const RunScope scope(run);
  parts_->prepared = prepared.parts();
  parts_->options = options;
  const Prepared::Parts& from = *prepared.parts();
  if (!options.path_tracing) require_possible_radiosity(from.scene);
  Session& session = from.context->session;
  StageLog& stages = from.context->stages;
  require_memory(prepared, options);
  IndirectLight& indirect = parts_->light.indirect;
  if (options.photons || options.path_tracing) {
    parts_->light = run_light_stages(session, from.ready.on_device, parts_->request(), stages);
  } else {
    IndirectRequest request = parts_->request();
    if (!options.pass_file.empty())
      request.after_pass = [&](unsigned pass, const IndirectLight& so_far) {
        const LitCloud lit = pointgi::lit_cloud(parts_->request(), so_far, options.pass_content.exposure);
        const std::string file = name_of_pass(options.pass_file, pass);
        write_lit_ply(file, from.scene, from.ready, lit);
        log_info("light of pass {}: {}", pass, file);
      };
    const std::optional<ShaftLight> shafts = shaft_light_of(session, from.ready.on_device, request, stages);
    request.shafts = shafts ? &*shafts : nullptr;
    indirect = run_indirect_stages(session, from.ready.on_device, request, stages);
    finish_exchange(parts_->request(), indirect);
  }
  if (!indirect.from_surfaces.empty()) {
    parts_->irradiance = upload_irradiance(session, indirect, from.scene);
    parts_->warned_of_dark = warn_of_unlit(from.scene, from.ready, indirect.direct, indirect.from_surfaces);
  }
}

std::vector<float> Light::radiosity(const RunControl& run) const {
  const RunScope scope(run);
  const LitCloud lit = parts_->lit_cloud({});
  std::vector<float> radiosity(3 * lit.cloud.size());
  for (std::size_t i = 0; i < radiosity.size(); ++i)
    radiosity[i] = lit.columns[i % 3].values[i / 3];
  return radiosity;
}

std::vector<float> Light::sky(const RunControl& run) const {
  const RunScope scope(run);
  return parts_->sky_of_points();
}

void Light::write_ply(const std::string& file, const LitFileOptions& with, const RunControl& run) const {
  const RunScope scope(run);
  const LitCloud lit = parts_->lit_cloud(with);
  write_lit_ply(file, parts_->prepared->scene, parts_->prepared->ready, lit);
}

void Light::write_las(const std::string& file, const LitFileOptions& with, const RunControl& run) const {
  const RunScope scope(run);
  const Prepared::Parts& from = *parts_->prepared;
  if (!can_write_las(from.scene) || !from.ready.file_order)
    throw Error(ErrorKind::usage, file + ": only a scene of one LAS file and nothing else becomes LAS; write PLY");
  const LitCloud lit = parts_->lit_cloud(with);
  write_lit_las(file, from.scene, from.ready, lit);
}

} // namespace pointgi::api
