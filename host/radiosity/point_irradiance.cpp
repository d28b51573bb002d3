#include "host/radiosity/point_irradiance.h"
#include "host/cl/batches.h"
#include "host/passes/device_lights.h"
#include <numeric>

namespace pointgi {

namespace {

/// Points of the first launch, of which nothing is known yet.
constexpr std::size_t first_points = 256, group = 64;

} // namespace

Buffer<float> direct_irradiance_of_points(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                          const DeviceLighting& lighting, double side, std::size_t points,
                                          unsigned samples, bool with_emitters, const std::function<bool()>& stop,
                                          std::optional<View<std::uint32_t>> places) {
  SceneFeatures features{lighting.light_types, with_emitters && !lighting.emitters.empty(), lighting.has_environment};
  if (!session.info().is_cpu) features = {all_lights, with_emitters, true}; // one of few programs: features_on()
  features.sky_map = lighting.sky != nullptr;
  const Program program = direct_irradiance_program(variant, features);
  cl::Kernel kernel = session.kernel(program.file, program.options, "direct_irradiance_of_points");
  RenderParams params = lighting.params;
  params.step_delta = static_cast<float>(variant.step_delta / side);
  const DeviceLights lights = upload_lights(session, lighting, params, true);
  auto irradiance = session.allocate<float>(3 * points);
  session.fill(irradiance, 0.0f, 3 * points);
  std::vector<std::uint32_t> all(places ? 0 : points);
  std::iota(all.begin(), all.end(), 0u);
  const View<std::uint32_t> which = places ? *places : View<std::uint32_t>(all);
  if (which.size == 0) return irradiance;
  const auto place_buffer = session.upload(which.data, which.size);
  Pace pace(first_points, busy_work_items(session.info()));
  for_each_batch(EqualItems{which.size}, pace, {stop, {}}, [&](std::size_t first, std::size_t count) {
    return session.launch(kernel, LaunchShape::line(count, group), pools.nodes, pools.leaves, pools.points,
                          lights.arguments(), place_buffer, irradiance, static_cast<cl_uint>(first),
                          static_cast<cl_uint>(first + count), samples);
  });
  return irradiance;
}

} // namespace pointgi
