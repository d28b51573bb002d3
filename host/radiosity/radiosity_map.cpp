#include "host/radiosity/radiosity_map.h"
#include "host/cache/binary_cache.h"
#include "host/cache/vmap_cache.h"
#include "host/cl/kernel_source.h"
#include "host/passes/visibility.h"
#include "host/radiosity/parts_of_faces.h"
#include <cstdio>

namespace pointgi {

std::vector<std::uint32_t> exchanging_points(const ExchangeScene& scene) {
  std::vector<std::uint32_t> places;
  for (std::uint32_t p = 0; p < scene.points.size; ++p)
    if (scene.exchanges.size == 0 || scene.exchanges[static_cast<std::size_t>(scene.points[p].material)] != 0)
      places.push_back(p);
  return places;
}

std::vector<Splat> points_at(const ExchangeScene& scene, View<std::uint32_t> places) {
  std::vector<Splat> points;
  points.reserve(places.size);
  for (const std::uint32_t p : places)
    points.push_back(scene.points[p]);
  return points;
}

namespace {

/// Passes questions on and reports how many were answered.
class ReportedVisibility : public VisibilityOracle {
public:
  ReportedVisibility(VisibilityOracle& oracle, const WorkReport& report) : oracle_(oracle), report_(report) {}

  std::vector<std::uint8_t> blocked(View<Segment> segments) override {
    auto answers = oracle_.blocked(segments);
    rays_ += segments.size;
    char text[40];
    std::snprintf(text, sizeof text, "%.1f million rays", 1e-6 * static_cast<double>(rays_));
    report_(text);
    return answers;
  }

private:
  VisibilityOracle& oracle_;
  const WorkReport& report_;
  std::uint64_t rays_ = 0;
};

/// More than rooms and models ask for at the default settings (8 M of 19k points, 16 M of 54k, 245 M of 440k and a
/// ground) and at coarser ones (66 M of the 440k at four times the epsilon); foliage would ask for thousands a point.
std::uint64_t default_vmap_rays(std::size_t points, const RadiositySettings& settings) {
  constexpr double least = 0.4; // near pairs remain, however coarse epsilon is
  const RadiositySettings usual;
  const double finer = std::max(least, usual.epsilon / settings.epsilon) *
                       std::max(1.0, static_cast<double>(settings.vmap_samples) / usual.vmap_samples);
  return static_cast<std::uint64_t>(std::min(1e18, finer * (1e7 + 500.0 * static_cast<double>(points))));
}

/// The tree over them, and their places in its order.
void cluster(Session& session, const ExchangeScene& scene, float step_delta, bool thesis, RadiosityMap& map) {
  const std::vector<std::uint32_t> places = exchanging_points(scene);
  const std::vector<Splat> points = points_at(scene, places);
  const auto ask = [&](View<Splat> ends, View<Segment> segments) {
    return DeviceVisibility(session, scene.pools, scene.variant, ends, step_delta).blocked(segments);
  };
  std::vector<std::uint32_t> parts;
  if (!thesis) parts = parts_of_faces(points, ask);
  map.tree = build_clusters(points, ClusterOptions{}, parts);
  for (const std::uint32_t k : map.tree.order)
    map.place.push_back(places[k]);
}

} // namespace

RadiosityMap map_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                            const WorkReport& report) {
  RadiosityMap map;
  const TraversalVariant& variant = scene.variant;
  const auto step_delta = static_cast<float>(variant.step_delta / scene.side);
  cluster(session, scene, step_delta, settings.vmap == "thesis", map);
  if (map.place.empty()) return map;
  DeviceVisibility oracle(session, scene.pools, variant, map.tree.points, step_delta);
  LinkOptions options;
  options.samples = static_cast<unsigned>(settings.vmap_samples);
  options.point_samples = static_cast<unsigned>(settings.point_samples);
  options.epsilon = static_cast<float>(settings.epsilon);
  options.most_rays = settings.vmap_rays ? static_cast<std::uint64_t>(*settings.vmap_rays)
                                         : default_vmap_rays(map.place.size(), settings);
  options.seed = scene.seed;
  options.thesis = settings.vmap == "thesis";
  const DeviceInfo& device = session.info();
  ReportedVisibility reported(oracle, report);
  char more[80];
  std::snprintf(more, sizeof more, ", delta %a, kernels %016llx",
                variant.stepping == Stepping::absolute_delta ? variant.step_delta / scene.side : 0.0,
                static_cast<unsigned long long>(fnv1a(kernel_source(segments_program(variant).file))));
  map.vmap = kept_or_made_links(map.tree, scene.points, reported, options,
                                device.name + ", " + device.driver + ", " + name_of(variant) + more, &map.kept);
  return map;
}

} // namespace pointgi
