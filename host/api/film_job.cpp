#include "host/api/parts.h"
#include "host/api/scene_hash.h"
#include "host/run.h"
#include "host/scene/load_sections.h"
#include "host/stages/view_warnings.h"
#include <cstdio>

namespace pointgi::api {

namespace {

toml::array array_of(const std::array<double, 3>& v) {
  return toml::array{v[0], v[1], v[2]};
}

/// The options as the sections of a scene file, so that one place checks both.
toml::table sections_of(const FilmOptions& options, const RenderSettings& render) {
  toml::table film{{"size", toml::array{options.width.value_or(render.width), options.height.value_or(render.height)}}};
  if (options.spp) film.insert("spp", *options.spp);
  if (options.seed) film.insert("seed", static_cast<std::int64_t>(*options.seed));
  toml::table sections{{"render", std::move(film)}};
  if (!options.camera) return sections;
  toml::table camera{{"position", array_of(options.camera->position)},
                     {"look_at", array_of(options.camera->look_at)},
                     {"fov_deg", options.camera->fov_deg}};
  if (options.camera->up) camera.insert("up", array_of(*options.camera->up));
  sections.insert("camera", std::move(camera));
  return sections;
}

void look(const FilmOptions& options, pointgi::Scene& view) {
  const toml::table sections = sections_of(options, view.render);
  const std::string name = "film";
  const TableReader root(sections, name, "");
  load_render(root, view.render);
  if (!options.camera) return;
  const std::optional<Backfaces> backfaces = view.camera.backfaces;
  view.camera = {};
  load_camera(root, view.up, view.camera);
  view.camera.backfaces = backfaces;
}

PixelWindow window_of(const FilmOptions& options, const RenderSettings& render) {
  if (!options.window) return {0, render.width, 0, render.height};
  const auto& [x0, x1, y0, y1] = *options.window;
  if (x0 < 0 || x0 >= x1 || x1 > render.width || y0 < 0 || y0 >= y1 || y1 > render.height)
    throw Error(ErrorKind::usage,
                "film.window: expected x0, x1, y0, y1 with 0 <= x0 < x1 <= " + std::to_string(render.width) +
                    " and 0 <= y0 < y1 <= " + std::to_string(render.height) + ", found " + std::to_string(x0) + ", " +
                    std::to_string(x1) + ", " + std::to_string(y0) + ", " + std::to_string(y1));
  return {x0, x1, y0, y1};
}

} // namespace

FilmJob::FilmJob(Light::Parts& light, const FilmOptions& options)
    : light_(light), paths_(options.paths), view_(light.prepared->scene), lighting_(light.prepared->ready.lighting) {
  if (!options.paths.empty() && !light.options.path_tracing)
    throw Error(ErrorKind::usage, "film.paths: only path-traced light can choose the light paths that count");
  look(options, view_);
  const PreparedScene& ready = light.prepared->ready;
  lighting_.params.camera = device_camera(view_, ready.frame);
  lighting_.params.samples = static_cast<pg_uint>(view_.render.spp);
  lighting_.params.seed = view_.render.seed;
  std::optional<LightPaths> paths;
  if (light.options.path_tracing) paths = light_paths(options.paths, view_.render.max_depth);
  request_.emplace(
      RenderRequest{window_of(options, view_.render), lighting_, ready.frame, ready.ids, ready.choice.variant, paths});
  request_->first_ids = ready.first_ids;
  request_->backfaces = view_.camera.backfaces.value_or(Backfaces::shade);
  request_->auxiliary = options.auxiliary;
  if (light.irradiance.size > 0) {
    request_->irradiance = &light.irradiance;
    request_->cones = light.light.indirect.at_pixels ? &*light.light.indirect.at_pixels : nullptr;
    request_->shadow_rays = !direct_light_by_radiosity(view_);
  }
  if (light.light.direct) {
    request_->stored_direct = &light.light.direct->texels;
    lighting_.params.sky_at_points = light.light.direct->sky ? 1u : 0u;
  }
  request_->normal_field = light.light.normal_field ? &*light.light.normal_field : nullptr;
  request_->photons = light.light.photons ? &*light.light.photons : nullptr;
}

std::vector<ChannelName> FilmJob::channels() const {
  return film_channels(request_->has_indirect(), request_->has_specular(), request_->has_caustics(),
                       request_->auxiliary);
}

PictureAttributes FilmJob::attributes() const {
  const Prepared::Parts& prepared = *light_.prepared;
  const DeviceInfo& device = prepared.context->session.info();
  PictureAttributes attributes;
  const std::string integrator = light_.options.path_tracing ? "path" : "pointgi";
  attributes.text["software"] = "pointgi " POINTGI_VERSION;
  attributes.text["pointgi/device"] = device.name + " (" + device.platform + ")";
  attributes.text["pointgi/scene_hash"] = scene_hash(prepared.ready.points, lighting_, view_, integrator, paths_);
  attributes.text["pointgi/quality"] = prepared.quality;
  attributes.text["pointgi/integrator"] = integrator;
  if (!paths_.empty()) attributes.text["pointgi/paths"] = paths_;
  attributes.number["samplesPerPixel"] = view_.render.spp;
  attributes.world_to_camera = world_to_camera(view_);
  attributes.world_to_ndc = world_to_ndc(view_);
  return attributes;
}

RenderTotals FilmJob::render(const std::function<void(const Band&)>& take) {
  const Prepared::Parts& prepared = *light_.prepared;
  if (light_.options.path_tracing)
    light_.warned_of_dark = warn_of_paths(paths_, view_, prepared.ready) || light_.warned_of_dark;
  StageLog& stages = prepared.context->stages;
  stages.start("render");
  RenderTotals totals = pointgi::render(
      prepared.context->session, prepared.ready.on_device, *request_, take,
      [](double share) { report_progress(share); }, stop_asked);
  stages.finish(totals.rays, "rays", totals.device_seconds);
  return totals;
}

GrowingFilm FilmJob::growing() const {
  const Prepared::Parts& prepared = *light_.prepared;
  return {prepared.context->session, prepared.ready.on_device, *request_};
}

void FilmJob::set_samples(int samples) {
  view_.render.spp = samples;
  lighting_.params.samples = static_cast<pg_uint>(samples);
}

void FilmJob::warn(const RenderTotals& totals) const {
  warn_of_view(totals, view_, light_.prepared->ready, light_.warned_of_dark);
}

} // namespace pointgi::api
