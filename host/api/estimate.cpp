#include "host/api/estimate.h"
#include "host/api/parts.h"
#include "host/passes/visibility.h"
#include "host/photon/photon_map.h"
#include "host/radiosity/point_irradiance.h"
#include "host/run.h"
#include "host/stages/device_need.h"
#include "host/stages/exchange_sample.h"
#include "host/stages/require_memory.h"
#include "octree/clock.h"
#include <algorithm>
#include <cmath>

namespace pointgi::api {

double PictureEstimate::seconds() const {
  double all = 0.0;
  for (const StageEstimate& stage : stages)
    all += stage.seconds;
  return all;
}

std::uint64_t PictureEstimate::peak_bytes() const {
  std::uint64_t peak = 0;
  for (const StageEstimate& stage : stages)
    peak = std::max(peak, stage.bytes);
  return peak;
}

const StageEstimate* PictureEstimate::stage(const std::string& name) const {
  for (const StageEstimate& stage : stages)
    if (stage.stage == name) return &stage;
  return nullptr;
}

namespace {

/// Flights that tell what a photon costs; a picture that tells what a pixel does, in parts of a side.
constexpr long long first_photons = 2000, few_photons = 40000;
constexpr int first_part = 8, finest_part = 2;
constexpr double enough_seconds = 0.15; ///< of the small picture
/// Seconds of writing a channel of a pixel to the EXR, and a pixel to the PNG, on the machine of
/// docs/user/quality-and-time.md: little beside all else, so that another machine's do not matter.
constexpr double seconds_of_channel = 6e-8, seconds_of_png_pixel = 4e-7;
/// Of light that goes round between surfaces and mirrors: rounds after the first, whose solutions together take about
/// as long as the first one.
constexpr double more_rounds = 2.0, rounds_solved = 1.0;

class Estimator {
public:
  Estimator(const Prepared& prepared, const FilmOptions& film)
      : prepared_(*prepared.parts()), session_(prepared_.context->session), stages_(prepared_.context->stages),
        other_log_(stages_), light_{prepared.parts(), {}, {}, {}, false, {}}, request_(light_.request()), film_(film),
        pool_(prepared_.points().size), held_(session_.held_bytes()) {}

  PictureEstimate estimate() {
    const PreparedScene& ready = prepared_.ready;
    require_light_memory(session_, request_,
                         {prepared_.scene, ready.points, ready.ids, ready.first_ids, ready.frame.side}, true);
    for (const StageRecord& record : other_log_.before().records())
      if (record.ran && (record.name == "scene" || record.name == "cloud" || record.name == "octree"))
        estimate_.stages.push_back({record.name, true, "every scene", record.seconds,
                                    record.name == "octree" ? held_ : 0, static_cast<double>(record.items),
                                    record.unit});
    find_shafts();
    estimate_exchange();
    store_direct_light();
    estimate_photons();
    estimate_pixels();
    return std::move(estimate_);
  }

private:
  StageEstimate& add(const std::string& stage, const std::string& why, double seconds, std::uint64_t needed) {
    estimate_.stages.push_back({stage, true, why, seconds, held_ + needed, 0.0, {}});
    return estimate_.stages.back();
  }
  void skip(const std::string& stage, const std::string& why) {
    estimate_.stages.push_back({stage, false, why, 0.0, 0, 0.0, {}});
  }

  /// Kernels of direct light and of segments run once.
  void warm_up(bool with_emitters) {
    direct_irradiance_of_points(session_, prepared_.ready.on_device, request_.variant, request_.lighting,
                                request_.frame.side, std::min<std::size_t>(64, pool_), 1, with_emitters,
                                [] { return false; });
    const auto delta = static_cast<float>(request_.variant.step_delta / request_.frame.side);
    const std::vector<Segment> one(1);
    DeviceVisibility(session_, prepared_.ready.on_device, request_.variant, request_.points, delta).blocked(one);
  }

  void find_shafts() {
    shafts_ = shaft_light_of(session_, prepared_.ready.on_device, request_, stages_);
    request_.shafts = shafts_ ? &*shafts_ : nullptr;
    const StageRecord& record = stages_.records().back();
    if (!record.ran)
      skip("shafts", record.reason);
    else
      add("shafts", "the scene has lamps or [[light]]s", record.seconds, 0);
  }

  /// By a part of the estimates; how long all would take.
  std::vector<float> find_direct_light(bool with_emitters, bool with_sky, double& seconds) {
    constexpr unsigned part = 8;
    const unsigned samples = direct_light_samples(request_, with_emitters), few = (samples + part - 1) / part;
    const Clock::time_point begin = Clock::now();
    std::vector<float> direct = light_of_sources(session_, prepared_.ready.on_device, request_, with_emitters, few);
    const std::vector<float> sky =
        with_sky ? light_of_sky(session_, prepared_.ready.on_device, request_, few) : std::vector<float>(direct.size());
    for (std::size_t i = 0; i < direct.size(); ++i)
      direct[i] += sky[i];
    seconds = seconds_since(begin) * samples / few;
    return direct;
  }

  void estimate_exchange() {
    const RadiositySettings& settings = request_.scene.radiosity;
    const RadiosityMethod* method = radiosity_method(settings.method);
    const auto skip_both = [&](const std::string& reason) {
      skip("vmap", reason);
      skip(method != nullptr ? method->name : radiosity_methods().front()->name, reason);
    };
    if (const std::string reason = reason_against_radiosity(request_); !reason.empty()) return skip_both(reason);
    const std::vector<std::uint8_t> exchanging = exchanging_materials(request_.scene);
    const ExchangeScene exchange = exchange_scene(prepared_.ready.on_device, request_, exchanging);
    const bool emitters_exchange = direct_light_by_radiosity(request_.scene);
    const std::uint64_t light_bytes = 3 * sizeof(float) * pool_ + sky_bytes(request_.lighting);
    warm_up(!emitters_exchange);
    ExchangePlan plan;
    double direct_seconds = 0.0, map_seconds = 0.0;
    std::string why = "radiosity.method = \"" + settings.method + "\"";
    if (settings.method == "auto") {
      plan = plan_exchange(session_, exchange, request_, stages_);
      method = plan.choice.method;
      why = plan.choice.reason;
      add("plan", "radiosity.method = \"auto\"", stages_.records().back().seconds,
          std::max(light_bytes, vmap_bytes(plan.clusters.place.size(), 1u << 17)));
      if (method == nullptr) return skip_both(why);
    } else {
      if (method->without_vmap == nullptr) {
        const Clock::time_point begin = Clock::now();
        plan.clusters = cluster_points(session_, exchange, settings);
        plan.choice.vmap = estimate_visibility(session_, exchange, settings, plan.clusters);
        map_seconds = seconds_since(begin);
      }
    }
    const bool sky_is_told = tells_sky(*method, request_);
    direct_ = find_direct_light(!emitters_exchange, !sky_is_told, direct_seconds);
    if (!plan.sources.empty()) direct_seconds = 0.0; // in `plan`
    if (sky_is_told) stored_sky_.assign(3 * pool_, 0.0f);
    std::vector<float> emitted;
    if (emitters_exchange) emitted = emitted_radiosity(request_.lighting, request_.points);
    ExchangeEstimate found = sample_exchange(session_, exchange, settings, *method,
                                             {{direct_, emitted}, plan.clusters.tree, plan.choice.vmap});
    if (method->without_vmap != nullptr)
      skip("vmap", settings.method == "auto" ? why : method->without_vmap);
    else {
      StageEstimate& map = add("vmap", why, map_seconds + found.vmap_seconds, found.vmap_bytes);
      map.items = found.links;
      map.unit = "links";
    }
    const CausticSettings& caustics = request_.scene.caustics;
    const bool goes_round = caustics.feedback && caustics.indirect && request_.lighting.has_specular();
    StageEstimate& solved =
        add(method->name, why,
            direct_seconds + found.prepare_seconds + (goes_round ? 1.0 + rounds_solved : 1.0) * found.solve_seconds,
            std::max(light_bytes, found.method_bytes));
    solved.items = static_cast<double>(pool_);
    solved.unit = "points";
    estimate_.exchange_rays = found.rays;
    estimate_.applies = found.applies;
    exchanges_ = true;
    // What pixels read of it: any light does, for the time that it takes.
    light_.irradiance = session_.upload(std::vector<cl_float4>(pool_));
    light_.light.indirect.at_pixels = std::move(found.at_pixels);
    held_ = std::max(held_ + sizeof(cl_float4) * pool_, session_.held_bytes());
  }

  /// What pixels read of it: as much as they will, of whatever light.
  void store_direct_light() {
    IndirectLight light;
    light.sky = std::move(stored_sky_);
    light_.light.direct = upload_direct(session_, request_, light);
    held_ = std::max(held_, session_.held_bytes());
  }

  /// The stage `photon` with so many; its seconds.
  double fly(long long photons, Caustics& caustics) {
    pointgi::Scene scene = request_.scene;
    scene.caustics.photons = photons;
    const IndirectRequest request{request_.variant, scene, request_.frame, request_.lighting, request_.points};
    const Clock::time_point begin = Clock::now();
    caustics = run_photon_stage(session_, prepared_.ready.on_device, request,
                                light_.light.normal_field ? &*light_.light.normal_field : nullptr, stages_);
    return seconds_since(begin);
  }

  /// As many as this share of all, by direct light alone; its seconds.
  double fly_from_surfaces(double share, Caustics& caustics) {
    const Clock::time_point begin = Clock::now();
    add_indirect_photons(session_, prepared_.ready.on_device, request_, *light_.light.normal_field,
                         reflected_radiosity(request_, {direct_}), share, 1, caustics, stages_);
    return seconds_since(begin);
  }

  void estimate_photons() {
    const Clock::time_point begin = Clock::now();
    light_.light.normal_field =
        normal_field_of(session_, request_.lighting, request_.points, request_.variant.patches, stages_);
    const StageRecord normals = stages_.records().back();
    if (!normals.ran)
      skip("normals", normals.reason);
    else
      add("normals", "a surface is specular", seconds_since(begin), sizeof(cl_float4) * pool_);
    held_ = std::max(held_, session_.held_bytes());
    const long long all = request_.scene.caustics.photons, few = std::min(all, std::max(few_photons, all / 10));
    Caustics first, some;
    fly(std::min(all, first_photons), first); // builds its kernels
    if (const StageRecord record = stages_.records().back(); !record.ran) return skip("photon", record.reason);
    upload_caustics(session_, first, request_, stages_);
    const double few_seconds = fly(few, some), flying = some.ledger->device_seconds;
    const double more = static_cast<double>(all) / static_cast<double>(few);
    double seconds = few_seconds - flying + more * flying;
    const bool from_surfaces = request_.scene.caustics.indirect && exchanges_;
    if (from_surfaces) {
      fly_from_surfaces(1e-3, first);
      const double again = fly_from_surfaces(1.0 / more, some), flying_again = some.ledger->device_seconds - flying;
      // Later rounds send little, but look at all points as the first does.
      const double flights = request_.scene.caustics.feedback ? 1.0 + more_rounds : 1.0;
      seconds += flights * (again - flying_again) + more * flying_again;
    }
    Clock::time_point then = Clock::now();
    build_photon_map(some.photons);
    seconds += (more - 1.0) * seconds_since(then);
    then = Clock::now();
    light_.light.photons = upload_caustics(session_, some, request_, stages_);
    seconds += seconds_since(then);
    const auto stored = static_cast<std::uint64_t>(more * static_cast<double>(some.photons.size()));
    const double items = more * static_cast<double>(some.ledger->aimed);
    const auto flights_bytes =
        static_cast<std::uint64_t>(std::min(double{most_photon_flights}, items) * sizeof(PhotonFlight));
    const std::uint64_t map = photon_map_bytes(std::min<std::uint64_t>(stored, most_stored_photons), pool_);
    StageEstimate& photon = add("photon",
                                std::to_string(all) + " photons by way of specular surfaces" +
                                    (from_surfaces ? ", and as many from diffuse ones" : ""),
                                seconds, std::max(flights_bytes, map + 2 * sizeof(cl_float4) * pool_));
    photon.items = items;
    photon.unit = "photons";
    held_ += map;
  }

  void estimate_pixels() {
    const FilmJob whole(light_, film_);
    const RenderSettings& full = whole.settings();
    const PixelWindow window = whole.window();
    const double pixels = double(window.x1 - window.x0) * (window.y1 - window.y0);
    FilmOptions small = film_;
    small.window.reset();
    small.spp = std::min<int>(full.spp, GRID_RAYS);
    const auto draw = [&](int part, double& seconds) {
      small.width = std::max(1, full.width / part);
      small.height = std::max(1, full.height / part);
      FilmJob job(light_, small);
      const Clock::time_point begin = Clock::now();
      RenderTotals totals = job.render([](const Band&) {});
      if (totals.interrupted) throw interruption();
      seconds = seconds_since(begin);
      return totals;
    };
    double seconds = 0.0;
    draw(std::max(1, std::min(full.width, full.height) / 8), seconds); // its kernels run once
    int part = first_part;
    RenderTotals totals = draw(part, seconds);
    for (; part > finest_part && seconds < enough_seconds; totals = draw(part, seconds))
      part /= 2;
    const double drawn = double(*small.width) * *small.height;
    const double more = pixels / drawn * full.spp / *small.spp;
    const std::size_t channels = whole.channels().size();
    // Launches are as long as those of the small picture would have grown to be.
    const double a_pixel = std::max(totals.eye_seconds, totals.device_seconds - totals.eye_seconds) / drawn;
    const std::size_t film_channels =
        film_scalars(light_.light.normal_field.has_value(), light_.light.photons.has_value(), film_.auxiliary);
    const double columns = std::clamp(launch_seconds / std::max(1e-9, band_rows * a_pixel), 16.0,
                                      std::min(4096.0, std::max(16.0, double(window.x1 - window.x0))));
    StageEstimate& render = add(
        "render", fmt::format("{} x {} pixels of {} samples", window.x1 - window.x0, window.y1 - window.y0, full.spp),
        more * seconds + seconds_of_channel * static_cast<double>(channels) * pixels,
        tile_bytes(static_cast<std::size_t>(columns), film_channels) + sky_bytes(request_.lighting));
    render.items = more * static_cast<double>(totals.rays);
    render.unit = "rays";
    StageEstimate& image = add("image", "the picture is written", seconds_of_png_pixel * pixels, 0);
    image.items = pixels;
    image.unit = "pixels";
  }

  Prepared::Parts& prepared_;
  Session& session_;
  StageLog& stages_; ///< of the estimate
  StagesApart other_log_;
  Light::Parts light_; ///< by which small pictures are made
  IndirectRequest request_;
  const FilmOptions& film_;
  std::size_t pool_;
  std::uint64_t held_; ///< by the device, as the stages will have it
  bool exchanges_ = false;
  std::optional<ShaftLight> shafts_;
  std::vector<float> stored_sky_; ///< IndirectLight::sky
  std::vector<float> direct_;     ///< IndirectLight::direct, where light is exchanged
  PictureEstimate estimate_;
};

} // namespace

PictureEstimate estimate_picture(const Prepared& prepared, const FilmOptions& film, const RunControl& run) {
  const RunControl silent{run.stop, run.progress, {}}; // what the picture itself will say
  const RunScope scope(silent);
  return Estimator(prepared, film).estimate();
}

} // namespace pointgi::api
