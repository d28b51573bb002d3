/// radiosity.method = "cones": cones through a pyramid of voxels.
#include "host/radiosity/cones.h"
#include "host/radiosity/method.h"
#include "host/radiosity/solve_by_operator.h"

namespace pointgi {

namespace {

class PreparedCones : public PreparedRadiosity {
public:
  PreparedCones(Session& session, const ExchangeScene& scene, const RadiositySettings& settings)
      : pool_(scene.points), places_(exchanging_points(scene)), at_pixels_(settings.at == "pixels") {
    if (places_.empty()) return;
    const VoxelOptions options{static_cast<unsigned>(settings.voxels), settings.anisotropic};
    exchange_ =
        std::make_unique<ConeExchange>(session, scene.points, places_, options, static_cast<unsigned>(settings.cones));
  }

  RadiosityField solve(const EnteringLight& light, double tolerance, const WorkReport& report) override {
    return solve_by_operator(exchange_.get(), {pool_, places_}, light, tolerance, report);
  }
  std::optional<DeviceCones> cones_of(View<float> radiosity) override {
    if (!exchange_ || !at_pixels_) return std::nullopt;
    std::vector<cl_float4> light(radiosity.size / 3);
    for (std::size_t i = 0; i < radiosity.size; ++i)
      light[i / 3].s[i % 3] = radiosity[i];
    return exchange_->with_light(light);
  }
  std::uint64_t rays() const override { return 0; }
  std::string summary() const override {
    return std::to_string(exchange_ ? exchange_->pyramid().occupied() : 0) + " voxels that hold surface";
  }
  std::vector<MethodStatistic> statistics() const override {
    if (!exchange_) return {};
    return {{"radiosity", "occupied_voxels", exchange_->pyramid().occupied()},
            {"radiosity", "voxel_shares", exchange_->pyramid().shares()}};
  }

private:
  View<Splat> pool_;
  std::vector<std::uint32_t> places_;
  bool at_pixels_;
  std::unique_ptr<ConeExchange> exchange_; ///< absent: nothing exchanges light
};

std::unique_ptr<PreparedRadiosity> prepare(Session& session, const ExchangeScene& scene,
                                           const RadiositySettings& settings, std::optional<RadiosityMap>,
                                           const WorkReport&) {
  return std::make_unique<PreparedCones>(session, scene, settings);
}

} // namespace

extern const RadiosityMethod cones_method{
    "cones", "radiosity.method = \"cones\" looks through voxels, not along rays between points",
    true,    prepare,
    false,   false,
    true};

} // namespace pointgi
