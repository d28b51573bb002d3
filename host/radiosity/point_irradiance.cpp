#include "host/radiosity/point_irradiance.h"
#include <algorithm>

namespace pointgi {

namespace {

/// A launch aims at this many seconds, as the render stage's do.
constexpr double launch_seconds = 0.1;
constexpr std::size_t first_points = 256, fewest_points = 64, group = 64;

} // namespace

Buffer<float> direct_irradiance_of_points(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                          const DeviceLighting& lighting, double side, std::size_t points,
                                          unsigned samples, bool with_emitters, const std::function<bool()>& stop) {
  SceneFeatures features{!lighting.delta.empty(), with_emitters && !lighting.emitters.empty(),
                         lighting.has_environment};
  if (!session.info().is_cpu) features = {true, with_emitters, true}; // one of two programs: features_on()
  const Program program = direct_irradiance_program(variant, features);
  cl::Kernel kernel = session.kernel(program.file, program.options, "direct_irradiance_of_points");
  RenderParams params = lighting.params;
  params.step_delta = static_cast<float>(variant.step_delta / side);
  const auto device_params = session.upload(&params, 1);
  const auto materials = session.upload(lighting.materials);
  const auto delta = session.upload(lighting.delta);
  const auto emitters = session.upload(lighting.emitters);
  auto irradiance = session.allocate<float>(3 * points);
  session.fill(irradiance, 0.0f, 3 * points);
  std::size_t most = first_points;
  for (std::size_t first = 0; first < points && !stop();) {
    const std::size_t end = std::min(first + most, points);
    const double seconds = session.launch(kernel, LaunchShape::line(end - first, group), pools.nodes, pools.leaves,
                                          pools.points, device_params, materials, delta, emitters, irradiance,
                                          static_cast<cl_uint>(first), static_cast<cl_uint>(end), samples);
    first = end;
    if (seconds < 0.5 * launch_seconds)
      most *= 2;
    else if (seconds > 2.0 * launch_seconds)
      most = std::max(most / 2, fewest_points);
  }
  return irradiance;
}

} // namespace pointgi
