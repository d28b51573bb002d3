/// radiosity.method = "directions": each point looks for light in so many directions.
#include "host/radiosity/directions.h"
#include "host/radiosity/method.h"
#include "host/radiosity/shared_irradiance.h"
#include "host/radiosity/solve_by_operator.h"

namespace pointgi {

namespace {

/// Of more points a pixel shows several, and averages itself; the search for neighbours takes 120 bytes a point.
constexpr std::size_t most_that_share = 2'000'000;

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
    if (settings.share && exchange_->keeps_all() && places_.size() <= most_that_share)
      shared_ = std::make_unique<SharedIrradiance>(scene.points, places_, exchange_->mean_ways());
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    RadiosityField field = solve_by_operator(exchange_.get(), {pool_, places_}, light, tolerance, report);
    if (!shared_) return field;
    std::vector<float> irradiance(3 * places_.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i)
      irradiance[i] = field.irradiance[3 * places_[i / 3] + i % 3];
    shared_->share(irradiance, 3);
    to_pool(irradiance, field.irradiance);
    return field;
  }
  std::vector<float> sky(const DeviceLighting& lighting) override {
    std::vector<float> of_pool(3 * pool_.size);
    if (!exchange_) return of_pool;
    std::vector<float> seen = exchange_->sky(lighting);
    if (shared_) shared_->share(seen, 3);
    to_pool(seen, of_pool);
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
  /// Both [points x 3].
  void to_pool(View<float> of_places, std::vector<float>& of_pool) const {
    for (std::size_t i = 0; i < of_places.size; ++i)
      of_pool[3 * places_[i / 3] + i % 3] = of_places[i];
  }

  View<Splat> pool_;
  std::vector<std::uint32_t> places_;
  std::unique_ptr<DeviceDirections> exchange_; ///< absent: nothing exchanges light
  std::unique_ptr<SharedIrradiance> shared_;   ///< absent: each point is left with what its own rays find
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
