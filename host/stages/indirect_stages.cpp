#include "host/stages/indirect_stages.h"
#include "host/error.h"
#include "host/photon/trace_photons.h"
#include "host/run.h"
#include "host/stages/kept_light.h"
#include "host/stages/require_memory.h"
#include "host/stages/stage_watch.h"
#include "octree/parallel.h"
#include <algorithm>
#include <stdexcept>

namespace pointgi {

namespace {

/// Of light that enters besides, however little.
constexpr double coarsest_tolerance = 0.1;
constexpr std::size_t grain = 1 << 14; ///< points that a thread takes at a time

} // namespace

bool has_reflectors(const Scene& scene, View<Splat> points) {
  return std::any_of(points.begin(), points.end(), [&](const Splat& s) {
    return exchanges_light(scene.materials[static_cast<std::size_t>(s.material)]) &&
           (s.colour[0] > 0.0f || s.colour[1] > 0.0f || s.colour[2] > 0.0f);
  });
}

std::vector<std::uint8_t> exchanging_materials(const Scene& scene) {
  std::vector<std::uint8_t> exchanges;
  for (const MaterialSettings& material : scene.materials)
    exchanges.push_back(exchanges_light(material) ? 1 : 0);
  return exchanges;
}

std::vector<float> emitted_radiosity(const DeviceLighting& lighting, View<Splat> points) {
  std::vector<float> emitted(3 * points.size);
  parallel_ranges(points.size, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t c = 0; c < 3; ++c)
        emitted[3 * p + c] = 3.14159265f * lighting.materials[material_of(points[p])].emission[c];
  });
  return emitted;
}

std::vector<float> reflected_radiosity(const IndirectRequest& request, const std::vector<View<float>>& irradiances) {
  std::vector<float> reflected(3 * request.points.size);
  parallel_ranges(request.points.size, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Splat& s = request.points[p];
      if (!exchanges_light(request.scene.materials[material_of(s)])) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        float irradiance = 0.0f;
        for (const View<float>& one : irradiances)
          if (one.size > 0) irradiance += one[3 * p + c];
        reflected[3 * p + c] = s.colour[c] * irradiance;
      }
    }
  });
  return reflected;
}

double power_of(View<float> radiosity, View<Splat> points) {
  double power = 0.0;
  for (std::size_t i = 0; i < radiosity.size; ++i)
    power += double{radiosity[i]} * points[i / 3].area;
  return power;
}

bool direct_light_by_radiosity(const Scene& scene) {
  return scene.radiosity.direct_light == "radiosity";
}

Buffer<cl_float4> upload_irradiance(Session& session, const IndirectLight& light, const Scene& scene) {
  const bool with_direct = direct_light_by_radiosity(scene);
  std::vector<cl_float4> texels(light.from_surfaces.size() / 3);
  parallel_ranges(texels.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        texels[i].s[c] = light.at_pixels ? 0.0f : light.from_surfaces[3 * i + c];
        if (with_direct) texels[i].s[c] += light.direct[3 * i + c];
      }
  });
  return session.upload(texels);
}

void require_possible_radiosity(const Scene& scene) {
  if (scene.radiosity.place && scene.radiosity.method == "none" && direct_light_by_radiosity(scene))
    throw Error(ErrorKind::input,
                scene.radiosity.place->text() +
                    ": [radiosity] direct_light = \"radiosity\" wants a method that exchanges light, but method is "
                    "\"none\"; choose another method, or \"auto\"");
}

std::optional<Buffer<cl_float4>> normal_field_of(Session& session, const DeviceLighting& lighting, View<Splat> points,
                                                 bool patches, StageLog& stages) {
  if (!lighting.has_specular()) {
    stages.skip("normals", "no specular material");
    return std::nullopt;
  }
  if (patches) {
    stages.skip("normals", "patches of the surface have normals of their own");
    return session.upload(std::vector<cl_float4>(1));
  }
  stages.start("normals");
  const std::vector<cl_float4> texels = normal_field_texels(lighting, points);
  Buffer<cl_float4> field = session.upload(texels);
  stages.finish(texels.size(), "points");
  return field;
}

ExchangeScene exchange_scene(const DevicePools& pools, const IndirectRequest& request, View<std::uint8_t> exchanging) {
  return {pools, request.variant, request.points, exchanging, request.frame.side, request.scene.render.seed};
}

std::string reason_against_radiosity(const IndirectRequest& request) {
  if (request.by_paths) return "the path tracer makes the picture";
  if (request.scene.radiosity.method == "none") return "radiosity.method = \"none\": direct light only";
  if (!request.lighting.has_light()) return "the scene has no light and no emission";
  if (!has_reflectors(request.scene, request.points)) return "nothing in the scene is diffuse with an albedo above 0";
  return {};
}

namespace {

RadiosityMap run_vmap(Session& session, const ExchangeScene& exchange, const IndirectRequest& request,
                      std::optional<RadiosityMap> clusters, std::optional<LinkEstimate> expected, StageLog& stages) {
  stages.start("vmap");
  StageWatch watch(session);
  const RadiositySettings& settings = request.scene.radiosity;
  if (!clusters) clusters = cluster_points(session, exchange, settings);
  require_fmm_memory(session, clusters->tree, settings, expected.value_or(LinkEstimate{}));
  RadiosityMap map = find_visibility(session, exchange, settings, std::move(*clusters), expected, watch.report());
  if (map.kept) log_info("V-map: kept from an earlier run");
  stages.finish(map.vmap.links.size(), "links");
  return map;
}

/// Whether direct light has to be passed on by surfaces at all: not where the light between them cannot matter.
bool may_matter(const IndirectRequest& request, const RadiosityMap& clusters, View<float> direct) {
  const double least = request.scene.radiosity.least_share;
  double albedo = 0.0, brightest = 0.0;
  std::vector<float> reflected;
  reflected.reserve(3 * clusters.place.size());
  for (std::size_t k = 0; k < clusters.place.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const float rho = clusters.tree.points[k].colour[c];
      albedo = std::max(albedo, double{rho});
      reflected.push_back(rho * direct[3 * std::size_t{clusters.place[k]} + c]);
      brightest = std::max(brightest, double{reflected.back()});
    }
  if (!(brightest > 0.0)) return true; // who solves for no light says what is wrong
  return bound_of_exchange(clusters.tree, reflected, albedo, least) > least;
}

} // namespace

ExchangePlan plan_exchange(Session& session, const ExchangeScene& exchange, const IndirectRequest& request,
                           StageLog& stages) {
  stages.start("plan");
  StageWatch watch(session);
  const RadiositySettings& settings = request.scene.radiosity;
  const bool emitters_exchange = direct_light_by_radiosity(request.scene);
  ExchangePlan plan{{nullptr, {}, {}}, cluster_points(session, exchange, settings), {}, {}};
  // What mirrors throw, and what shines among the points, is not in the bound.
  const bool has_bound = settings.least_share > 0.0 && !request.lighting.has_specular() && !emitters_exchange;
  bool matters = true;
  if (has_bound) {
    const unsigned samples = direct_light_samples(request, true);
    plan.sources = light_of_sources(session, exchange.pools, request, true, samples);
    // Where directions may tell the sky, the bound alone asks for it here: a sum over all points.
    const bool sky_comes_later = tells_sky(*radiosity_method("directions"), request);
    std::vector<float> sky = light_of_sky(session, exchange.pools, request, sky_comes_later ? 1u : samples);
    matters = may_matter(request, plan.clusters, sum_of(plan.sources, sky));
    if (!sky_comes_later) plan.sky = std::move(sky);
  }
  if (!matters)
    plan.choice.reason = fmt::format("surfaces send each other less than {:g} of the light, radiosity.least_share",
                                     settings.least_share);
  else
    plan.choice = plan_method(session, exchange, settings, plan.clusters,
                              emitters_exchange && !request.lighting.emitters.empty());
  if (has_bound && plan.sky.empty() && (plan.choice.method == nullptr || !tells_sky(*plan.choice.method, request)))
    plan.sky = light_of_sky(session, exchange.pools, request, direct_light_samples(request, true));
  stages.finish(request.points.size, "points");
  log_info("radiosity: {}: {}",
           plan.choice.method != nullptr ? fmt::format("method \"{}\"", plan.choice.method->name) : "not solved",
           plan.choice.reason);
  return plan;
}

namespace {

/// All irradiance that surfaces passed on besides from_surfaces.
const std::vector<float>& entered(const IndirectLight& light) {
  return light.entered.empty() ? light.direct : light.entered;
}

/// All irradiance that surfaces pass on besides from_surfaces, where photons bring some.
std::vector<float> entering_light(const IndirectRequest& request, const std::vector<float>& direct) {
  std::vector<float> entering;
  if (request.caustic.size == 0) return entering;
  entering = direct;
  for (std::size_t i = 0; i < request.caustic.size; ++i)
    entering[i] += request.caustic[i];
  return entering;
}

/// What enters first: lights, what shines, and photons by way of specular surfaces. light.direct: that of lamps and
/// [[light]]s, if it is there already; `sky`: likewise.
RadiosityField run_exchange(Session& session, std::optional<RadiosityMap> map, const ExchangeScene& exchange,
                            const IndirectRequest& request, std::vector<float> sky, IndirectLight& light,
                            StageLog& stages) {
  stages.start(light.method->name);
  StageWatch watch(session);
  const RadiositySettings& settings = request.scene.radiosity;
  const bool emitters_exchange = direct_light_by_radiosity(request.scene);
  light.prepared = light.method->prepare(session, exchange, settings, std::move(map), watch.report());
  if (tells_sky(*light.method, request)) light.sky = light.prepared->sky(request.lighting);
  const unsigned samples = direct_light_samples(request, !emitters_exchange);
  if (light.direct.empty())
    light.direct = light_of_sources(session, exchange.pools, request, !emitters_exchange, samples);
  if (!light.sky.empty())
    sky = light.sky;
  else if (sky.empty())
    sky = light_of_sky(session, exchange.pools, request, samples);
  light.direct = sum_of(std::move(light.direct), sky);
  std::vector<float> emitted;
  if (emitters_exchange) emitted = emitted_radiosity(request.lighting, request.points);
  light.entered = entering_light(request, light.direct);
  if (request.after_pass)
    light.prepared->after_pass = [&](unsigned pass, const std::vector<float>& irradiance) {
      IndirectLight so_far;
      so_far.direct = light.direct;
      so_far.from_surfaces = irradiance;
      request.after_pass(pass, so_far);
    };
  RadiosityField field = light.prepared->solve({entered(light), emitted}, settings.tolerance, watch.report());
  light.prepared->after_pass = {};
  stages.finish(request.points.size, "points");
  return field;
}

void report_solution(const IndirectLight& light, const Solution& solution) {
  log_info("radiosity: method \"{}\", {}, {} {}{}, residual {:.2g}", light.method->name, light.prepared->summary(),
           solution.applies, light.method->has_passes ? "pass" : "application",
           solution.applies == 1      ? ""
           : light.method->has_passes ? "es"
                                      : "s",
           solution.residual);
  if (const std::string complaint = complaint_of(solution); !complaint.empty()) log_warning("radiosity: {}", complaint);
}

IndirectLight solve_indirect_light(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                   StageLog& stages) {
  IndirectLight light;
  const RadiositySettings& settings = request.scene.radiosity;
  light.method = radiosity_method(settings.method);
  for (const std::string& note : settings.notes)
    log_info("{}", note);
  const auto skip = [&](const std::string& reason) {
    stages.skip("vmap", reason);
    stages.skip(light.method != nullptr ? light.method->name : radiosity_methods().front()->name, reason);
  };
  if (const std::string reason = reason_against_radiosity(request); !reason.empty()) {
    if (settings.place && settings.method != "none")
      log_warning("{}: [radiosity] has no effect: {}", settings.place->text(), reason);
    skip(reason);
    return light;
  }
  const std::vector<std::uint8_t> exchanging = exchanging_materials(request.scene);
  const ExchangeScene exchange = exchange_scene(pools, request, exchanging);
  std::optional<RadiosityMap> clusters, map;
  std::optional<LinkEstimate> expected;
  std::vector<float> sky;
  std::string without_vmap;
  if (settings.method == "auto") {
    ExchangePlan plan = plan_exchange(session, exchange, request, stages);
    light.method = plan.choice.method;
    light.direct = std::move(plan.sources);
    sky = std::move(plan.sky);
    clusters = std::move(plan.clusters);
    expected = plan.choice.vmap;
    without_vmap = plan.choice.reason;
    if (light.method == nullptr) {
      light.direct = sum_of(std::move(light.direct), sky);
      skip(without_vmap);
      return light;
    }
  } else if (light.method->without_vmap != nullptr)
    without_vmap = light.method->without_vmap;
  if (light.method->without_vmap != nullptr) {
    clusters.reset();
    stages.skip("vmap", without_vmap);
  } else
    map = run_vmap(session, exchange, request, std::move(clusters), expected, stages);
  RadiosityField field = run_exchange(session, std::move(map), exchange, request, std::move(sky), light, stages);
  light.rays = light.prepared->rays();
  light.statistics = light.prepared->statistics();
  light.from_surfaces = std::move(field.irradiance);
  light.solution = std::move(field.solution);
  light.solution.radiosity = std::vector<double>(); // the picture is made of from_surfaces
  report_solution(light, light.solution);
  return light;
}

/// What the stages would have left besides the light of an earlier run.
void go_on_from_kept(Session& session, const DevicePools& pools, const IndirectRequest& request, StageLog& stages,
                     IndirectLight& light) {
  const char* const reason = "an earlier run has kept its light";
  stages.skip("vmap", reason);
  stages.skip(light.method != nullptr ? light.method->name : radiosity_methods().front()->name, reason);
  log_info("radiosity: {}", reason);
  if (light.method == nullptr) return;
  if (const std::string complaint = complaint_of(light.solution); !complaint.empty())
    log_warning("radiosity: {}", complaint);
  light.entered = entering_light(request, light.direct);
  light.prepare = [&session, &pools, &request, &stages, method = light.method] {
    const std::vector<std::uint8_t> exchanging = exchanging_materials(request.scene);
    const ExchangeScene exchange = exchange_scene(pools, request, exchanging);
    std::optional<RadiosityMap> map;
    if (method->without_vmap == nullptr) map = run_vmap(session, exchange, request, {}, {}, stages);
    stages.start(method->name);
    StageWatch watch(session);
    auto prepared = method->prepare(session, exchange, request.scene.radiosity, std::move(map), watch.report());
    stages.finish(request.points.size, "points");
    return prepared;
  };
}

/// By which light was solved, or may be.
PreparedRadiosity& prepared_of(IndirectLight& light) {
  if (light.prepared == nullptr) light.prepared = light.prepare();
  return *light.prepared;
}

} // namespace

IndirectLight run_indirect_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                  StageLog& stages) {
  if (!reason_against_radiosity(request).empty()) return solve_indirect_light(session, pools, request, stages);
  bool made = false;
  IndirectLight light = kept_or_made<IndirectLight>("exchange", [&] {
    made = true;
    return solve_indirect_light(session, pools, request, stages);
  });
  if (!made) go_on_from_kept(session, pools, request, stages, light);
  return light;
}

std::vector<float> add_exchange(Session& session, const IndirectRequest& request, View<float> entering, double share,
                                IndirectLight& light, StageLog& stages) {
  const RadiosityMethod& method = *light.method;
  if (!method.is_linear)
    throw std::logic_error("radiosity: light added to what a method that is not linear has solved");
  bool made = false;
  const double tolerance = std::min(request.scene.radiosity.tolerance / share, coarsest_tolerance);
  AddedExchange added = kept_or_made<AddedExchange>("exchange-again", [&] {
    PreparedRadiosity& prepared = prepared_of(light);
    stages.start(method.name);
    StageWatch watch(session);
    made = true;
    const std::uint64_t before = prepared.rays();
    AddedExchange solved;
    solved.field = prepared.solve({entering, {}}, tolerance, watch.report());
    solved.rays = prepared.rays() - before;
    return solved;
  });
  RadiosityField& field = added.field;
  light.rays += added.rays;
  if (light.entered.empty()) light.entered = light.direct;
  for (std::size_t i = 0; i < light.from_surfaces.size(); ++i) {
    light.from_surfaces[i] += field.irradiance[i];
    light.entered[i] += entering[i];
  }
  light.solution.applies += field.solution.applies;
  if (field.solution.end != SolveEnd::converged) light.solution.end = field.solution.end;
  if (!made) return std::move(field.irradiance);
  stages.finish(request.points.size, "points");
  report_solution(light, field.solution);
  return std::move(field.irradiance);
}

void finish_exchange(const IndirectRequest& request, IndirectLight& light) {
  const RadiositySettings& settings = request.scene.radiosity;
  if (light.prepare && light.prepared == nullptr && light.method->has_cones && settings.at == "pixels")
    prepared_of(light);
  light.prepare = {};
  if (light.prepared != nullptr) {
    std::vector<float> radiosity = reflected_radiosity(request, {entered(light), light.from_surfaces});
    if (direct_light_by_radiosity(request.scene)) {
      const std::vector<float> emitted = emitted_radiosity(request.lighting, request.points);
      for (std::size_t i = 0; i < radiosity.size(); ++i)
        radiosity[i] += emitted[i];
    }
    light.at_pixels = light.prepared->cones_of(radiosity);
  }
  light.entered = {};
  light.prepared.reset();
}

} // namespace pointgi
