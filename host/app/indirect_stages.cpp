#include "host/app/indirect_stages.h"
#include "host/app/progress.h"
#include "host/cloud/normal_field.h"
#include "host/error.h"
#include "host/passes/point_irradiance.h"
#include <algorithm>
#include <spdlog/spdlog.h>

namespace pointgi {

namespace {

/// Estimates of the direct light of each point. Lights that are points or far away need one, since nothing of them is
/// chosen at random while they are few; what other estimates scatter, the many senders of a receiver average out.
constexpr unsigned light_samples = 16, sure_lights = 4;

unsigned samples_for(const DeviceLighting& lighting, bool with_emitters) {
  const bool sure = !(with_emitters && !lighting.emitters.empty()) && !lighting.has_environment &&
                    lighting.delta.size() <= sure_lights;
  return sure ? 1 : light_samples;
}

/// Progress of a stage, and Ctrl-C, both at every launch of the device.
class StageWatch {
public:
  StageWatch(Session& session, const std::string& stage, const IndirectRequest& request)
      : session_(session), progress_(stage, request.quiet) {
    session_.before_launches([this, stage, stop = request.stop] {
      if (stop()) throw Error(ExitCode::interrupted, "interrupted in the stage " + stage + "; nothing was written");
      progress_.tell(done_);
    });
  }
  ~StageWatch() { session_.before_launches({}); }
  StageWatch(const StageWatch&) = delete;
  StageWatch& operator=(const StageWatch&) = delete;

  WorkReport report() {
    return [this](const std::string& done) { done_ = done; };
  }

private:
  Session& session_;
  Progress progress_;
  std::string done_ = "at work";
};

} // namespace

bool has_reflectors(const Scene& scene, View<Splat> points) {
  return std::any_of(points.begin(), points.end(), [&](const Splat& s) {
    return exchanges_light(scene.materials[static_cast<std::size_t>(s.material)]) &&
           (s.colour[0] > 0.0f || s.colour[1] > 0.0f || s.colour[2] > 0.0f);
  });
}

std::vector<float> emitted_radiosity(const DeviceLighting& lighting, View<Splat> points) {
  std::vector<float> emitted(3 * points.size);
  for (std::size_t p = 0; p < points.size; ++p)
    for (std::size_t c = 0; c < 3; ++c)
      emitted[3 * p + c] = 3.14159265f * lighting.materials[static_cast<std::size_t>(points[p].material)].emission[c];
  return emitted;
}

std::vector<float> reflected_radiosity(const IndirectRequest& request, const IndirectLight& light) {
  std::vector<float> reflected(3 * request.points.size);
  for (std::size_t i = 0; i < reflected.size(); ++i) {
    const Splat& s = request.points[i / 3];
    if (!exchanges_light(request.scene.materials[static_cast<std::size_t>(s.material)])) continue;
    const float caustic = request.caustic.size > 0 ? request.caustic[i] : 0.0f;
    reflected[i] = s.colour[i % 3] * (light.direct[i] + caustic + light.from_surfaces[i]);
  }
  return reflected;
}

bool direct_light_by_radiosity(const Scene& scene) {
  return scene.radiosity.direct_light == "radiosity";
}

Buffer<cl_float4> upload_irradiance(Session& session, const IndirectLight& light, const Scene& scene) {
  std::vector<float> sum = light.from_surfaces;
  for (std::size_t i = 0; i < sum.size() && direct_light_by_radiosity(scene); ++i)
    sum[i] += light.direct[i];
  std::vector<cl_float4> texels(sum.size() / 3);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = {{sum[3 * i], sum[3 * i + 1], sum[3 * i + 2], 0.0f}};
  return session.upload(texels);
}

void require_possible_radiosity(const Scene& scene) {
  if (scene.radiosity.place && scene.radiosity.method == "none" && direct_light_by_radiosity(scene))
    throw Error(ExitCode::input,
                scene.radiosity.place->text() +
                    ": [radiosity] direct_light = \"radiosity\" wants a method that exchanges light, but method is "
                    "\"none\"; choose another method, or \"shadow_rays\"");
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

std::string reason_against_radiosity(const IndirectRequest& request) {
  if (request.by_paths) return "the path tracer makes the picture";
  if (request.scene.radiosity.method == "none") return "radiosity.method = \"none\": direct light only";
  if (!request.lighting.has_light()) return "the scene has no light and no emission";
  if (!has_reflectors(request.scene, request.points)) return "nothing in the scene is diffuse with an albedo above 0";
  return {};
}

namespace {

std::vector<std::uint8_t> exchanging_materials(const Scene& scene) {
  std::vector<std::uint8_t> exchanges;
  for (const MaterialSettings& material : scene.materials)
    exchanges.push_back(exchanges_light(material) ? 1 : 0);
  return exchanges;
}

RadiosityMap run_vmap(Session& session, const ExchangeScene& exchange, const IndirectRequest& request,
                      StageLog& stages) {
  stages.start("vmap");
  StageWatch watch(session, "vmap", request);
  RadiosityMap map = map_visibility(session, exchange, request.scene.radiosity, watch.report());
  if (map.kept) spdlog::info("V-map: kept from an earlier run");
  stages.finish(map.vmap.links.size(), "links");
  return map;
}

std::vector<float> direct_light(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                bool with_emitters) {
  const std::size_t points = request.points.size;
  return session.download(
      direct_irradiance_of_points(session, pools, request.variant, request.lighting, request.frame.side, points,
                                  samples_for(request.lighting, with_emitters), with_emitters, [] { return false; }),
      3 * points);
}

/// By the links of `map`, or where there is none by a ray a pair.
RadiosityField run_fmm(Session& session, const ExchangeScene& exchange, const IndirectRequest& request,
                       const RadiosityMap* map, std::vector<float>& direct, StageLog& stages) {
  stages.start("fmm");
  StageWatch watch(session, "fmm", request);
  const RadiositySettings& settings = request.scene.radiosity;
  const bool emitters_exchange = direct_light_by_radiosity(request.scene);
  direct = direct_light(session, exchange.pools, request, !emitters_exchange);
  std::vector<float> emitted;
  if (emitters_exchange) emitted = emitted_radiosity(request.lighting, request.points);
  std::vector<float> entering = direct;
  for (std::size_t i = 0; i < request.caustic.size; ++i)
    entering[i] += request.caustic[i];
  const EnteringLight light{entering, emitted};
  RadiosityField field = map != nullptr ? solve_radiosity_field(session, *map, light, settings, watch.report())
                                        : solve_radiosity_directly(session, exchange, light, settings, watch.report());
  stages.finish(request.points.size, "points");
  return field;
}

} // namespace

std::vector<float> direct_light_of_points(Session& session, const DevicePools& pools, const IndirectRequest& request) {
  const StageWatch watch(session, "direct light", request);
  if (!request.lighting.has_light()) return std::vector<float>(3 * request.points.size);
  return direct_light(session, pools, request, true);
}

IndirectLight run_indirect_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                  StageLog& stages) {
  IndirectLight light;
  const RadiositySettings& settings = request.scene.radiosity;
  if (const std::string reason = reason_against_radiosity(request); !reason.empty()) {
    if (settings.place && settings.method != "none")
      spdlog::warn("{}: [radiosity] has no effect: {}", settings.place->text(), reason);
    stages.skip("vmap", reason);
    stages.skip("fmm", reason);
    return light;
  }
  const std::vector<std::uint8_t> exchanges = exchanging_materials(request.scene);
  const ExchangeScene exchange{pools,     request.variant,    request.points,
                               exchanges, request.frame.side, request.scene.render.seed};
  const bool directly = settings.method == "direct";
  RadiosityMap map;
  if (directly)
    stages.skip("vmap", "radiosity.method = \"direct\" traces a ray for every pair of points");
  else
    map = run_vmap(session, exchange, request, stages);
  light.links = map.vmap.statistics;
  RadiosityField field = run_fmm(session, exchange, request, directly ? nullptr : &map, light.direct, stages);
  light.counts = field.counts;
  light.rays = field.rays;
  light.from_surfaces = std::move(field.irradiance);
  light.solution = std::move(field.solution);
  spdlog::info("radiosity: {}, {} applies of the operator, residual {:.2g}",
               directly ? "a ray a pair" : std::to_string(map.vmap.links.size()) + " links", light.solution.applies,
               light.solution.residual);
  if (const std::string complaint = complaint_of(light.solution); !complaint.empty())
    spdlog::warn("radiosity: {}", complaint);
  return light;
}

} // namespace pointgi
