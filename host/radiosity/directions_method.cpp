/// radiosity.method = "directions": each point looks for light in so many directions.
#include "host/radiosity/directions.h"
#include "host/radiosity/method.h"
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
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    return solve_by_operator(exchange_.get(), {pool_, places_}, light, tolerance, report);
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
  View<Splat> pool_;
  std::vector<std::uint32_t> places_;
  std::unique_ptr<DeviceDirections> exchange_; ///< absent: nothing exchanges light
};

std::unique_ptr<PreparedRadiosity> prepare(Session& session, const ExchangeScene& scene,
                                           const RadiositySettings& settings, std::optional<RadiosityMap>,
                                           const WorkReport& report) {
  return std::make_unique<PreparedDirections>(session, scene, settings, report);
}

} // namespace

extern const RadiosityMethod directions_method{
    "directions", "radiosity.method = \"directions\" traces rays from each point into its own hemisphere", true,
    prepare};

} // namespace pointgi
