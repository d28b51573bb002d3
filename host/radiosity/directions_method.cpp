/// radiosity.method = "directions": each point looks for light in so many directions.
#include "host/radiosity/directions.h"
#include "host/radiosity/method.h"
#include "host/radiosity/shared_irradiance.h"
#include "host/radiosity/solve_by_operator.h"

namespace pointgi {

namespace {

class PreparedDirections : public PreparedRadiosity {
public:
  PreparedDirections(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                     const WorkReport& report)
      : pool_(scene.points), places_(exchanging_points(scene)) {
    if (places_.empty()) return;
    DirectionsOptions options;
    options.directions = static_cast<unsigned>(settings.directions);
    options.pattern = settings.direction_set == "hemicube" ? DirectionPattern::hemicube : DirectionPattern::stratified;
    options.seed = scene.seed;
    options.step_delta = static_cast<float>(scene.variant.step_delta / scene.side);
    options.progress = [&](double share) {
      report(std::to_string(static_cast<int>(100.0 * share)) + " % of the rays");
    };
    exchange_ = std::make_unique<DeviceDirections>(session, scene.pools, scene.variant, scene.points, places_, options);
    shares_ = settings.share && exchange_->keeps_all();
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    RadiosityField field = solve_by_operator(exchange_.get(), {pool_, places_}, light, tolerance, report);
    if (!shares_) return field;
    field.solution.radiosity = std::vector<double>(); // sharing takes its memory
    std::vector<float> irradiance(3 * places_.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i)
      irradiance[i] = field.irradiance[3 * places_[i / 3] + i % 3];
    shared().share(irradiance, 3, field.irradiance);
    return field;
  }
  std::vector<float> sky(const DeviceLighting& lighting) override {
    std::vector<float> of_pool(3 * pool_.size);
    if (!exchange_) return of_pool;
    const std::vector<float> seen = exchange_->sky(lighting);
    if (shares_)
      shared().share(seen, 3, of_pool);
    else
      for (std::size_t i = 0; i < seen.size(); ++i)
        of_pool[3 * places_[i / 3] + i % 3] = seen[i];
    return of_pool;
  }
  std::uint64_t rays() const override { return exchange_ ? exchange_->rays() : 0; }
  std::string summary() const override {
    return exchange_ ? std::to_string(exchange_->directions()) + " directions a point" : "no point exchanges light";
  }
  std::vector<MethodStatistic> statistics() const override {
    if (!exchange_) return {};
    return {{"radiosity", "directions", exchange_->directions()},
            {"radiosity", "hit_bytes", exchange_->kept_bytes()},
            {"radiosity", "beam_rays", exchange_->beam_rays()}};
  }

private:
  /// Made late: while light is solved for, memory is short.
  const SharedIrradiance& shared() {
    if (!shared_) shared_ = std::make_unique<SharedIrradiance>(pool_, places_, exchange_->mean_ways());
    return *shared_;
  }

  View<Splat> pool_;
  std::vector<std::uint32_t> places_;
  std::unique_ptr<DeviceDirections> exchange_; ///< absent: nothing exchanges light
  bool shares_ = false;                        ///< else each point is left with what its own rays find
  std::unique_ptr<SharedIrradiance> shared_;   ///< once it was asked for
};

std::unique_ptr<PreparedRadiosity> prepare(Session& session, const ExchangeScene& scene,
                                           const RadiositySettings& settings, std::optional<RadiosityMap>,
                                           const WorkReport& report) {
  return std::make_unique<PreparedDirections>(session, scene, settings, report);
}

} // namespace

extern const RadiosityMethod directions_method{
    "directions", "radiosity.method = \"directions\" traces rays from each point into its own hemisphere",
    true,         prepare,
    false,        true};

} // namespace pointgi
