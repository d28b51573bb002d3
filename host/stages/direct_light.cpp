/// Direct light of the points: by shafts, by shadow rays, from the sky.
#include "host/radiosity/point_irradiance.h"
#include "host/run.h"
#include "host/stages/kept_light.h"
#include "host/stages/stage_watch.h"
#include <algorithm>

namespace pointgi {

namespace {

/// Estimates of the direct light of a point that is seen only by what it sends on: the many senders of a receiver
/// average out what the estimates of each scatter.
constexpr int indirect_light_samples = 16;

DeviceLighting without_environment(const DeviceLighting& lighting) {
  DeviceLighting sources = lighting;
  sources.has_environment = false;
  sources.sky.reset();
  sources.smooth_sky.clear();
  std::fill_n(sources.params.environment, 3, 0.0f);
  return sources;
}

DeviceLighting environment_alone(const DeviceLighting& lighting) {
  DeviceLighting sky = lighting;
  sky.light_sources.clear();
  sky.emitters.clear();
  sky.light_types = sky.params.light_sources = sky.params.emitters = 0;
  return sky;
}

} // namespace

unsigned direct_light_samples(const IndirectRequest& request, bool with_emitters) {
  const DeviceLighting& lighting = request.lighting;
  // Of few lights without a size nothing is chosen at random.
  const bool sure = !(with_emitters && !lighting.emitters.empty()) && !lighting.has_environment &&
                    (lighting.light_types & SIZED_LIGHTS) == 0 && lighting.light_sources.size() <= ALL_LIGHT_SOURCES;
  if (sure) return 1;
  const Scene& scene = request.scene;
  // Light that the picture shows at the points has the samples of a pixel.
  const int default_samples = direct_light_by_radiosity(scene) ? scene.render.spp : indirect_light_samples;
  return static_cast<unsigned>(scene.radiosity.light_samples.value_or(default_samples));
}

bool tells_sky(const RadiosityMethod& method, const IndirectRequest& request) {
  const DeviceLighting& lighting = request.lighting;
  return method.tells_sky && lighting.has_environment && (lighting.sky == nullptr || !lighting.smooth_sky.empty());
}

std::vector<float> light_of_sources(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                    bool with_emitters, unsigned samples) {
  const DeviceLighting lighting = without_environment(request.lighting);
  const std::size_t points = request.points.size;
  // What lamps that exchange light send is no direct light, and shafts have summed it up, too.
  const bool all_of_them = with_emitters || lighting.emitters.empty();
  if (request.shafts != nullptr && all_of_them) return request.shafts->irradiance;
  return session.download(direct_irradiance_of_points(session, pools, request.variant, lighting, request.frame.side,
                                                      points, samples, with_emitters, stop_asked),
                          3 * points);
}

std::vector<float> light_of_sky(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                unsigned samples) {
  const std::size_t points = request.points.size;
  if (!request.lighting.has_environment) return std::vector<float>(3 * points);
  return session.download(direct_irradiance_of_points(session, pools, request.variant,
                                                      environment_alone(request.lighting), request.frame.side, points,
                                                      samples, false, stop_asked),
                          3 * points);
}

std::vector<float> sum_of(std::vector<float> a, View<float> b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    a[i] += b[i];
  return a;
}

std::vector<float> direct_light_of_points(Session& session, const DevicePools& pools, const IndirectRequest& request) {
  const StageWatch watch(session);
  if (!request.lighting.has_light()) return std::vector<float>(3 * request.points.size);
  const unsigned samples = direct_light_samples(request, true);
  return sum_of(light_of_sources(session, pools, request, true, samples),
                light_of_sky(session, pools, request, samples));
}

std::optional<ShaftLight> shaft_light_of(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                         StageLog& stages) {
  const DeviceLighting& lighting = request.lighting;
  const auto skip = [&](const char* reason) {
    stages.skip("shafts", reason);
    return std::nullopt;
  };
  if (request.by_paths) return skip("the path tracer makes the picture");
  if (lighting.light_sources.empty() && lighting.emitters.empty())
    return skip("the scene has no lamp and no [[light]]");
  if (request.scene.radiosity.direct_light != "auto")
    return skip(direct_light_by_radiosity(request.scene) ? "radiosity.direct_light = \"radiosity\""
                                                         : "radiosity.direct_light = \"shadow_rays\"");
  if (request.variant.patches) return skip("patches of the surface stick out of shafts");
  stages.start("shafts");
  const StageWatch watch(session);
  ShaftLight light = kept_or_made<ShaftLight>("shafts", [&] {
    ShaftLight made = light_through_shafts(request.points, lighting);
    std::vector<std::uint32_t> unknown;
    for (std::uint32_t i = 0; i < made.known.size(); ++i)
      if (made.known[i] == 0) unknown.push_back(i);
    const std::vector<float> by_rays = session.download(
        direct_irradiance_of_points(session, pools, request.variant, without_environment(lighting), request.frame.side,
                                    request.points.size, direct_light_samples(request, true), true, stop_asked,
                                    View<std::uint32_t>(unknown)),
        3 * request.points.size);
    add_light_by_rays(by_rays, made);
    return made;
  });
  stages.finish(request.points.size, "points");
  log_info("shafts: {:.0f} % of the points see all of their lamps, or nothing; the others ask shadow rays",
           100.0 * static_cast<double>(light.known_points) /
               static_cast<double>(std::max<std::size_t>(1, request.points.size)));
  return light;
}

std::optional<StoredDirect> upload_direct(Session& session, const IndirectRequest& request,
                                          const IndirectLight& light) {
  const bool some_known = request.shafts != nullptr && request.shafts->known_points > 0;
  if (request.scene.radiosity.direct_light != "auto" || request.by_paths || (!some_known && light.sky.empty()))
    return std::nullopt;
  std::vector<cl_float4> texels(2 * request.points.size);
  for (std::size_t i = 0; i < request.points.size; ++i) {
    const bool known = some_known && request.shafts->known[i] != 0;
    float of_sources = 0.0f, all = 0.0f;
    for (std::size_t c = 0; c < 3; ++c) {
      const float sources = known ? request.shafts->irradiance[3 * i + c] : 0.0f;
      texels[2 * i].s[c] = sources + (light.sky.empty() ? 0.0f : light.sky[3 * i + c]);
      of_sources += sources;
      all += texels[2 * i].s[c];
    }
    texels[2 * i].s[3] = known ? 1.0f : 0.0f;
    for (std::size_t c = 0; c < 3 && all > 0.0f; ++c)
      texels[2 * i + 1].s[c] = known ? request.shafts->change[3 * i + c] * (of_sources / all) : 0.0f;
  }
  return StoredDirect{session.upload(texels), !light.sky.empty()};
}

std::vector<float> sky_of_points(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                 unsigned samples) {
  const StageWatch watch(session);
  // An even sky of radiance 1/pi, unblocked, gives an irradiance of 1.
  DeviceLighting sky;
  sky.materials = request.lighting.materials;
  sky.params = request.lighting.params;
  sky.params.light_sources = sky.params.emitters = 0;
  std::fill_n(sky.params.environment, 3, 0.318309886f);
  sky.has_environment = true;
  const std::size_t points = request.points.size;
  const std::vector<float> irradiance =
      session.download(direct_irradiance_of_points(session, pools, request.variant, sky, request.frame.side, points,
                                                   samples, false, [] { return false; }),
                       3 * points);
  std::vector<float> share(points);
  for (std::size_t p = 0; p < points; ++p)
    share[p] = std::clamp(irradiance[3 * p], 0.0f, 1.0f); // the sum of the estimates rounds
  return share;
}

} // namespace pointgi
