#include "host/photon/device_flight.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr std::size_t group = 64;

/// Whether photons set out in directions of the environment's map.
bool from_map(const PhotonRequest& request) {
  return request.lighting.sky != nullptr && request.sources.has_environment();
}

SceneFeatures features_of(const PhotonRequest& request) {
  const DeviceLighting& lighting = request.lighting;
  SceneFeatures features;
  features.sky_map = from_map(request);
  features.lights = lighting.light_types;
  features.materials = lighting.material_types;
  features.material_flags = lighting.flags;
  return features;
}

/// With the request's sources instead of the lighting's.
DeviceLights lights_of(Session& session, const PhotonRequest& request) {
  RenderParams params = request.lighting.params;
  params.seed += request.flight * 0x9e3779b9u;
  params.step_delta = static_cast<float>(request.variant.step_delta / request.side);
  std::copy_n(request.sources.environment.begin(), 3, params.environment);
  params.light_sources = static_cast<pg_uint>(request.sources.light_sources.size());
  params.emitters = static_cast<pg_uint>(request.sources.emitters.size());
  DeviceLights lights = upload_lights(session, request.lighting, params, from_map(request));
  lights.light_sources = session.upload(request.sources.light_sources);
  lights.emitters = session.upload(request.sources.emitters);
  return lights;
}

cl::Kernel kernel_of(Session& session, const PhotonRequest& request) {
  const Program program =
      trace_photons_program(request.variant, features_on(session.info(), features_of(request)), request.start);
  return session.kernel(program.file, program.options, "trace_photons");
}

} // namespace

DeviceFlight::DeviceFlight(Session& session, const DevicePools& pools, const PhotonRequest& request)
    : session_(session), pools_(pools), kernel_(kernel_of(session, request)), photons_(request.plan.photons),
      lights_(lights_of(session, request)), normal_field_(request.normal_field),
      radiance_(session.upload(request.sources.radiance)), batches_(session.upload(request.plan.batches)),
      leaves_(session.upload(request.leaves.leaves)), leaf_splats_(session.upload(request.leaves.splats)),
      leaf_of_(session.upload(request.leaves.leaf_of)) {}

double DeviceFlight::launch(const Buffer<PhotonFlight>& flights, std::size_t first, std::size_t count) {
  return session_.launch(kernel_, LaunchShape::line(count, group), pools_.nodes, pools_.leaves, pools_.points,
                         normal_field_, lights_.arguments(), radiance_, batches_, leaves_, leaf_splats_, leaf_of_,
                         flights, static_cast<cl_uint>(batches_.size), static_cast<cl_uint>(first),
                         static_cast<cl_uint>(count));
}

} // namespace pointgi
