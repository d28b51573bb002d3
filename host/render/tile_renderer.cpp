#include "host/render/tile_renderer.h"
#include "shared/traversal_types.h"
#include <algorithm>

namespace pointgi {

namespace {

/// POOL_PARAMS of kernels/lib/pools.cl, in its order.
std::vector<cl::Memory> pool_arguments(const DevicePools& pools, const Buffer<cl_float4>* irradiance,
                                       const Buffer<cl_float4>* normal_field, const DevicePhotonMap* photons,
                                       const DeviceCones* cones, const Buffer<cl_float4>* stored_direct) {
  std::vector<cl::Memory> all{pools.nodes, pools.leaves, pools.points};
  if (irradiance != nullptr) all.push_back(irradiance->handle);
  if (stored_direct != nullptr) all.push_back(stored_direct->handle);
  if (cones != nullptr)
    all.insert(all.end(), {cones->grid.handle, cones->cones.handle, cones->voxels.handle, cones->cells.handle});
  if (normal_field != nullptr) all.push_back(normal_field->handle);
  if (photons != nullptr)
    all.insert(all.end(),
               {photons->nodes.handle, photons->buckets.handle, photons->params.handle, photons->at_points.handle});
  return all;
}

} // namespace

TileRenderer::TileRenderer(Session& session, const DevicePools& pools, const DeviceLighting& lighting, double side,
                           const TraversalVariant& variant, const std::optional<LightPaths>& paths,
                           const Buffer<cl_float4>* irradiance, bool shadow_rays, const Buffer<cl_float4>* normal_field,
                           const DevicePhotonMap* photons, Backfaces backfaces, const DeviceCones* cones,
                           const Buffer<cl_float4>* stored_direct, std::size_t pool_points, bool auxiliary)
    : session_(session), octree_(pool_arguments(pools, nullptr, nullptr, nullptr, nullptr, nullptr)),
      params_(lighting.params), grouping_(variant.grouping), eye_group_(variant.group),
      shade_group_(paths ? WorkGroup{} : variant.group),
      film_channels_(film_scalars(normal_field != nullptr, photons != nullptr, auxiliary)) {
  params_.step_delta = static_cast<float>(variant.step_delta / side);
  // Without, what shines and has a size is still seen, and so is the sky.
  const bool asks_lights = paths || shadow_rays;
  SceneFeatures features{asks_lights ? lighting.light_types : lighting.light_types & SIZED_LIGHTS,
                         !lighting.emitters.empty(), asks_lights && lighting.has_environment,
                         !paths && irradiance != nullptr, asks_lights};
  features.sky_map = lighting.sky != nullptr;
  features.auxiliary = auxiliary;
  if (!paths && cones != nullptr) features.cone_texels = cones->texels;
  if (normal_field != nullptr) {
    features.materials = lighting.material_types;
    features.material_flags = lighting.flags;
    features.gather_k = photons != nullptr ? photons->k : 0;
  }
  // Programs of other devices are few, and all take it.
  features.stored_direct = !paths && shadow_rays && (stored_direct != nullptr || !session.info().is_cpu);
  if (features.stored_direct && stored_direct == nullptr) {
    nothing_stored_ = session.allocate<cl_float4>(2 * std::max<std::size_t>(1, pool_points));
    session.fill(nothing_stored_, cl_float4{}, nothing_stored_.size);
    params_.sky_at_points = 0;
  }
  points_ = pool_arguments(pools, paths ? nullptr : irradiance, normal_field, photons, paths ? nullptr : cones,
                           !features.stored_direct    ? nullptr
                           : stored_direct != nullptr ? stored_direct
                                                      : &nothing_stored_);
  if (paths) {
    std::copy(paths->states.begin(), paths->states.end(), params_.path_states);
    params_.most_bounces = paths->most_bounces;
  }
  features = features_on(session.info(), features);
  const Program eye_rays = eye_rays_program(variant, backfaces),
                shade = paths ? path_program(variant, features, !paths->all) : shade_program(variant, features);
  eye_rays_ = session.kernel(eye_rays.file, eye_rays.options, "trace_eye_rays");
  shade_ = session.kernel(shade.file, shade.options, paths ? "path_pixels" : "shade_pixels");
  lights_ = upload_lights(session, lighting, params_, true);
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
  seconds.eye =
      session_.launch(eye_rays_, grouping_ == RayGrouping::packet ? squares : pixels(eye_group_), octree_,
                      lights_.params, hits_, number(x), number(y), number(columns), number(rows), number(first_sample));
  seconds.shade = session_.launch(shade_, pixels(shade_group_), points_, lights_.arguments(), hits_, film_, number(x),
                                  number(y), number(columns), number(rows), number(first_sample));
  return seconds;
}

void TileRenderer::set_samples(pg_uint samples) {
  if (params_.samples == samples) return;
  params_.samples = samples;
  session_.write(lights_.params, &params_, 1);
}

void TileRenderer::go_on_from(const std::vector<float>& film) {
  if (film_.size < film.size()) film_ = session_.allocate<float>(film.size());
  session_.write(film_, film.data(), film.size());
}

std::vector<EyeHits> TileRenderer::hits(int columns, int rows) {
  return session_.download(hits_, static_cast<std::size_t>(columns) * rows);
}

std::vector<float> TileRenderer::film(int columns, int rows) {
  return session_.download(film_, static_cast<std::size_t>(columns) * rows * film_channels());
}

} // namespace pointgi
