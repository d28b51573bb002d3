#include "host/api/parts.h"
#include "host/error.h"
#include "host/run.h"
#include "host/stages/view_warnings.h"

namespace pointgi::api {

IndirectRequest Light::Parts::request() const {
  const PreparedScene& ready = prepared->ready;
  return {ready.choice.variant, prepared->scene, ready.frame, ready.lighting, prepared->points(), options.path_tracing};
}

LitCloud Light::Parts::lit_cloud(double exposure) {
  if (options.path_tracing)
    throw Error(ErrorKind::usage, "light of path tracing holds no radiosity; solve the light without path_tracing");
  Prepared::Parts& from = *prepared;
  IndirectLight& indirect = light.indirect;
  if (indirect.direct.empty()) {
    log_warning("no light between surfaces: {}", reason_against_radiosity(request()));
    indirect.direct = direct_light_of_points(from.context->session, from.ready.on_device, request());
  }
  if (!warned_of_dark) warned_of_dark = warn_of_unlit(from.scene, from.ready, indirect.direct, indirect.from_surfaces);
  return pointgi::lit_cloud(request(), indirect, exposure);
}

Light::Light(const Prepared& prepared, const LightOptions& options, const RunControl& run) : parts_(new Parts) {
  const RunScope scope(run);
  parts_->prepared = prepared.parts();
  parts_->options = options;
  const Prepared::Parts& from = *prepared.parts();
  if (!options.path_tracing) require_possible_radiosity(from.scene);
  Session& session = from.context->session;
  StageLog& stages = from.context->stages;
  IndirectLight& indirect = parts_->light.indirect;
  if (options.photons || options.path_tracing) {
    parts_->light = run_light_stages(session, from.ready.on_device, parts_->request(), stages);
  } else {
    indirect = run_indirect_stages(session, from.ready.on_device, parts_->request(), stages);
    indirect.prepared.reset();
  }
  if (!indirect.from_surfaces.empty()) {
    parts_->irradiance = upload_irradiance(session, indirect, from.scene);
    parts_->warned_of_dark = warn_of_unlit(from.scene, from.ready, indirect.direct, indirect.from_surfaces);
  }
}

std::vector<float> Light::radiosity(const RunControl& run) const {
  const RunScope scope(run);
  const LitCloud lit = parts_->lit_cloud(0.0);
  std::vector<float> radiosity(3 * lit.cloud.size());
  for (std::size_t i = 0; i < radiosity.size(); ++i)
    radiosity[i] = lit.columns[i % 3].values[i / 3];
  return radiosity;
}

void Light::write_ply(const std::string& file, double exposure, const RunControl& run) const {
  const RunScope scope(run);
  const LitCloud lit = parts_->lit_cloud(exposure);
  pointgi::write_ply(file, lit.cloud, lit.columns);
}

} // namespace pointgi::api
