/// radiosity.method = "gather": progressive refinement, a bounce of light a pass.
#include "host/radiosity/bounces.h"
#include "host/radiosity/gather.h"
#include "host/radiosity/method.h"
#include "host/run.h"

namespace pointgi {

namespace {

GatherSampling sampling_of(const RadiositySettings& settings) {
  if (settings.sampling == "static") return GatherSampling::fixed;
  if (settings.sampling == "monte_carlo") return GatherSampling::monte_carlo;
  if (settings.sampling == "mipmap") return GatherSampling::mipmap;
  return settings.sampling == "adaptive" ? GatherSampling::adaptive : GatherSampling::all;
}

class PreparedGather : public PreparedRadiosity {
public:
  PreparedGather(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                 const WorkReport& report)
      : report_(report), pool_(scene.points), sampling_(settings.sampling),
        passes_(static_cast<unsigned>(settings.passes)) {
    const std::vector<std::uint32_t> places = exchanging_points(scene);
    if (places.empty()) return;
    tree_ = build_clusters(points_at(scene, places), ClusterOptions{});
    for (const std::uint32_t k : tree_.order)
      places_.push_back(places[k]);
    GatherOptions options;
    options.sampling = sampling_of(settings);
    options.window = static_cast<unsigned>(settings.window);
    const bool all = options.sampling == GatherSampling::all;
    options.reciprocity = all && settings.reciprocity.value_or(true);
    const bool can_keep =
        options.sampling != GatherSampling::monte_carlo && options.sampling != GatherSampling::adaptive;
    options.visibility_cache = can_keep && settings.visibility_cache.value_or(true);
    options.seed = scene.seed;
    options.step_delta = static_cast<float>(scene.variant.step_delta / scene.side);
    options.progress = [this](double share) {
      report_("pass " + std::to_string(pass_ + 1) + ", " + std::to_string(static_cast<int>(100.0 * share)) +
              " % of its rays");
    };
    Occupancy occupancy;
    if (settings.visibility == "voxels") {
      occupancy = upload_occupancy(session, scene.points, static_cast<unsigned>(settings.voxels));
      options.occupancy = &occupancy;
    }
    if (options.visibility_cache)
      log_info("gather: the visibility cache takes {}",
               megabytes(gather_cache_bytes(options.sampling, tree_.points.size(),
                                            all ? 0 : sender_windows(tree_, options.window).windows.size())));
    gather_ = std::make_unique<DeviceGather>(session, scene.pools, scene.variant, tree_, options);
    refines_ = options.sampling == GatherSampling::adaptive;
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    report_ = report;
    BounceOptions options;
    options.tolerance = tolerance;
    options.only_passes = passes_;
    options.after_pass = after_pass;
    options.whole = refines_;
    const auto pass = [&](View<double> radiosity, unsigned number, std::vector<double>& irradiance) {
      pass_ = number;
      gather_->gather(radiosity, number, irradiance);
      report_(std::to_string(number + 1) + " passes");
      return gather_->is_refined();
    };
    return solve_by_bounces(pass, {pool_, places_}, light, options);
  }

  std::uint64_t rays() const override { return gather_ ? gather_->rays() : 0; }
  std::string summary() const override {
    return gather_ ? "sampling \"" + sampling_ + "\", " + std::to_string(gather_->senders()) + " senders a point"
                   : "no point exchanges light";
  }
  std::vector<MethodStatistic> statistics() const override {
    if (!gather_) return {};
    return {{"radiosity", "senders", gather_->senders()}, {"radiosity", "cache_bytes", gather_->cache_bytes()}};
  }

private:
  WorkReport report_;
  View<Splat> pool_;
  std::string sampling_;
  unsigned passes_, pass_ = 0;
  bool refines_ = false;
  ClusterTree tree_;
  std::vector<std::uint32_t> places_;    ///< in the pool, of each point in the tree's order
  std::unique_ptr<DeviceGather> gather_; ///< absent: nothing exchanges light
};

std::unique_ptr<PreparedRadiosity> prepare(Session& session, const ExchangeScene& scene,
                                           const RadiositySettings& settings, std::optional<RadiosityMap>,
                                           const WorkReport& report) {
  return std::make_unique<PreparedGather>(session, scene, settings, report);
}

} // namespace

extern const RadiosityMethod gather_method{
    "gather", "radiosity.method = \"gather\" traces a ray for every pair of a receiver and a sender", true, prepare,
    true};

} // namespace pointgi
