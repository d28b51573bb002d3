#include "host/render/tile_renderer.h"
#include "shared/traversal_types.h"
#include <algorithm>

namespace pointgi {

TileRenderer::TileRenderer(Session& session, const DevicePools& pools, const DeviceLighting& lighting, double side,
                           const TraversalVariant& variant, const std::optional<LightPaths>& paths,
                           const Buffer<cl_float4>* irradiance, bool shadow_rays, const Buffer<cl_float4>* normal_field,
                           const DevicePhotonMap* photons)
    : session_(session), pools_(pools), params_(lighting.params), grouping_(variant.grouping),
      eye_group_(variant.group), shade_group_(paths ? WorkGroup{} : variant.group),
      irradiance_(paths ? nullptr : irradiance), normal_field_(normal_field), photons_(photons) {
  params_.step_delta = static_cast<float>(variant.step_delta / side);
  const bool asks_lights = paths || shadow_rays; // without, splats that shine are still seen, and so is the sky
  SceneFeatures features{asks_lights ? lighting.light_types : 0u, !lighting.emitters.empty(),
                         asks_lights && lighting.has_environment, irradiance_ != nullptr, asks_lights};
  if (normal_field_ != nullptr) {
    features.materials = lighting.material_types;
    features.material_flags = lighting.flags;
    features.gather_k = photons_ != nullptr ? photons_->k : 0;
  }
  if (paths) {
    std::copy(paths->states.begin(), paths->states.end(), params_.path_states);
    params_.most_bounces = paths->most_bounces;
  }
  features = features_on(session.info(), features);
  const Program eye_rays = eye_rays_program(variant),
                shade = paths ? path_program(variant, features, !paths->all) : shade_program(variant, features);
  eye_rays_ = session.kernel(eye_rays.file, eye_rays.options, "trace_eye_rays");
  shade_ = session.kernel(shade.file, shade.options, paths ? "path_pixels" : "shade_pixels");
  device_params_ = session.upload(&params_, 1);
  materials_ = session.upload(lighting.materials);
  delta_ = session.upload(lighting.delta);
  emitters_ = session.upload(lighting.emitters);
}

TileSeconds TileRenderer::launch(int x, int y, int columns, int rows, pg_uint first_sample) {
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  // Each on its own: where the second is refused, the first may be larger than a smaller tile needs.
  if (film_.size < width * height * film_channels()) film_ = session_.allocate<float>(width * height * film_channels());
  if (hits_.size < width * height) hits_ = session_.allocate<EyeHits>(width * height);
  const auto parts = [](std::size_t whole, std::size_t size) { return (whole + size - 1) / size; };
  const auto pixels = [&](WorkGroup g) {
    return LaunchShape::grid(parts(width, g.size() / GRID_RAYS) * g.x, height * g.y, g.x, g.y);
  };
  const LaunchShape squares = LaunchShape::grid(parts(width, PACKET_COLUMNS), parts(height, PACKET_ROWS), 1, 1);
  const auto number = [](auto value) { return static_cast<cl_uint>(value); };
  TileSeconds seconds;
  seconds.eye = session_.launch(eye_rays_, grouping_ == RayGrouping::packet ? squares : pixels(eye_group_),
                                pools_.nodes, pools_.leaves, pools_.points, device_params_, hits_, number(x), number(y),
                                number(columns), number(rows), number(first_sample));
  const auto shade = [&](const auto&... pools) {
    return session_.launch(shade_, pixels(shade_group_), pools..., device_params_, materials_, delta_, emitters_, hits_,
                           film_, number(x), number(y), number(columns), number(rows), number(first_sample));
  };
  const auto with_photons = [&](const auto&... pools) {
    return photons_ != nullptr
               ? shade(pools..., photons_->nodes, photons_->buckets, photons_->params, photons_->at_points)
               : shade(pools...);
  };
  const auto with_field = [&](const auto&... pools) {
    return normal_field_ != nullptr ? with_photons(pools..., *normal_field_) : with_photons(pools...);
  };
  seconds.shade = irradiance_ != nullptr ? with_field(pools_.nodes, pools_.leaves, pools_.points, *irradiance_)
                                         : with_field(pools_.nodes, pools_.leaves, pools_.points);
  return seconds;
}

std::vector<EyeHits> TileRenderer::hits(int columns, int rows) {
  return session_.download(hits_, static_cast<std::size_t>(columns) * rows);
}

std::vector<float> TileRenderer::film(int columns, int rows) {
  return session_.download(film_, static_cast<std::size_t>(columns) * rows * film_channels());
}

} // namespace pointgi
