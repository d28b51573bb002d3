/// radiosity.method = "direct": a ray a pair of points, the exact and slow way.
#include "host/radiosity/direct.h"
#include "host/radiosity/method.h"
#include "host/radiosity/solve_by_operator.h"
#include "host/run.h"

namespace pointgi {

namespace {

class PreparedDirect : public PreparedRadiosity {
public:
  PreparedDirect(Session& session, const ExchangeScene& scene, const WorkReport& report)
      : pool_(scene.points), places_(exchanging_points(scene)) { // whose order keeps close points together
    if (places_.empty()) return;
    const std::vector<Splat> points = points_at(scene, places_);
    DirectOptions options;
    options.step_delta = static_cast<float>(scene.variant.step_delta / scene.side);
    options.progress = [&](double share) {
      report(std::to_string(static_cast<int>(100.0 * share)) + " % of the rays");
    };
    log_info("direct: the visibility of all pairs takes {}", megabytes(direct_bytes(points.size())));
    exchange_ = std::make_unique<DeviceDirect>(session, scene.pools, scene.variant, points, options);
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    return solve_by_operator(exchange_.get(), {pool_, places_}, light, tolerance, report);
  }
  std::uint64_t rays() const override { return exchange_ ? exchange_->rays() : 0; }
  std::string summary() const override { return "a ray a pair"; }
  std::vector<MethodStatistic> statistics() const override {
    if (!exchange_) return {};
    return {{"radiosity", "cache_bytes", exchange_->kept_bytes()}};
  }

private:
  View<Splat> pool_;
  std::vector<std::uint32_t> places_;
  std::unique_ptr<DeviceDirect> exchange_; ///< absent: nothing exchanges light
};

std::unique_ptr<PreparedRadiosity> prepare(Session& session, const ExchangeScene& scene, const RadiositySettings&,
                                           std::optional<RadiosityMap>, const WorkReport& report) {
  return std::make_unique<PreparedDirect>(session, scene, report);
}

} // namespace

extern const RadiosityMethod direct_method{
    "direct", "radiosity.method = \"direct\" traces a ray for every pair of points", true, prepare};

} // namespace pointgi
