/// radiosity.method = "fmm": clusters of the V-map exchange light by the fast multipole method.
#include "host/radiosity/fmm.h"
#include "host/radiosity/method.h"
#include "host/radiosity/solve_by_operator.h"

namespace pointgi {

namespace {

class PreparedFmm : public PreparedRadiosity {
public:
  PreparedFmm(Session& session, View<Splat> pool, RadiosityMap map, const RadiositySettings& settings)
      : pool_(pool), map_(std::move(map)), order_(static_cast<unsigned>(settings.order)) {
    if (map_.place.empty()) return;
    FmmOptions options;
    options.grid.order = order_;
    exchange_ = std::make_unique<DeviceFmm>(session, map_.tree, map_.vmap.links, options, map_.vmap.point_shares);
    counts_ = count_exchanges(map_.tree, exchange_->lists());
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    return solve_by_operator(exchange_.get(), {pool_, map_.place}, light, tolerance, report);
  }
  std::uint64_t rays() const override { return map_.vmap.statistics.rays; }
  std::string summary() const override {
    return std::to_string(map_.vmap.links.size()) + " links" +
           (map_.vmap.statistics.coarse_waves > 0 ? " (the last ones coarser: radiosity.vmap_rays was reached)" : "");
  }
  std::vector<MethodStatistic> statistics() const override {
    const LinkStatistics& l = map_.vmap.statistics;
    return {{"radiosity", "order", order_},
            {"radiosity", "m2l", counts_.m2l},
            {"radiosity", "m2p", counts_.m2p},
            {"radiosity", "p2p", counts_.p2p},
            {"vmap", "pairs_tested", l.pairs_tested},
            {"vmap", "links", l.far + l.mid + l.near_},
            {"vmap", "far", l.far},
            {"vmap", "mid", l.mid},
            {"vmap", "near", l.near_},
            {"vmap", "waves", l.waves},
            {"vmap", "coarse_waves", l.coarse_waves},
            {"vmap", "rays", l.rays}};
  }

private:
  View<Splat> pool_;
  RadiosityMap map_; ///< which the operator refers to
  unsigned order_;
  std::unique_ptr<DeviceFmm> exchange_; ///< absent: nothing exchanges light
  ExchangeCounts counts_;
};

std::unique_ptr<PreparedRadiosity> prepare(Session& session, const ExchangeScene& scene,
                                           const RadiositySettings& settings, std::optional<RadiosityMap> map,
                                           const WorkReport&) {
  return std::make_unique<PreparedFmm>(session, scene.points, std::move(map.value()), settings);
}

} // namespace

// The flux decides to which side the mid links of a cluster shine, which is not quite linear
// (fmm/solve/radiosity_operator.h).
extern const RadiosityMethod fmm_method{"fmm", nullptr, true, prepare};

} // namespace pointgi
