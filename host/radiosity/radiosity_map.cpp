#include "host/radiosity/radiosity_map.h"
#include "host/cache/binary_cache.h"
#include "host/cache/vmap_cache.h"
#include "host/cl/kernel_source.h"
#include "host/passes/visibility.h"
#include "host/radiosity/parts_of_faces.h"
#include "octree/clock.h"
#include <algorithm>
#include <cstdio>

namespace pointgi {

std::vector<std::uint32_t> exchanging_points(const ExchangeScene& scene) {
  const auto exchanges = [&](std::uint32_t p) {
    return scene.exchanges.size == 0 || scene.exchanges[material_of(scene.points[p])] != 0;
  };
  std::size_t count = 0;
  for (std::uint32_t p = 0; p < scene.points.size; ++p)
    count += exchanges(p);
  std::vector<std::uint32_t> places;
  places.reserve(count);
  for (std::uint32_t p = 0; p < scene.points.size; ++p)
    if (exchanges(p)) places.push_back(p);
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

/// Passes questions on and reports how many were answered, and how long those take that are still expected.
class ReportedVisibility : public VisibilityOracle {
public:
  /// expected: how many rays there will be, asked before the first.
  ReportedVisibility(VisibilityOracle& oracle, std::function<double()> expected, const WorkReport& report)
      : oracle_(oracle), ask_expected_(std::move(expected)), report_(report) {}

  std::vector<std::uint8_t> blocked(View<Segment> segments) override {
    if (rays_ == 0.0) {
      expected_ = ask_expected_();
      begin_ = Clock::now();
    }
    auto answers = oracle_.blocked(segments);
    rays_ += static_cast<double>(segments.size);
    const double seconds = seconds_since(begin_);
    char text[100];
    if (rays_ < expected_)
      std::snprintf(text, sizeof text, "%.1f of about %.0f million rays, %.0f s left", 1e-6 * rays_, 1e-6 * expected_,
                    seconds * (expected_ / rays_ - 1.0));
    else
      std::snprintf(text, sizeof text, "%.1f million rays", 1e-6 * rays_);
    report_(text);
    return answers;
  }

private:
  VisibilityOracle& oracle_;
  std::function<double()> ask_expected_;
  double expected_ = 0.0;
  const WorkReport& report_;
  Clock::time_point begin_;
  double rays_ = 0.0;
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

float step_delta_of(const ExchangeScene& scene) {
  return static_cast<float>(scene.variant.step_delta / scene.side);
}

LinkOptions link_options(const ExchangeScene& scene, const RadiositySettings& settings, std::size_t points) {
  LinkOptions options;
  options.samples = static_cast<unsigned>(settings.vmap_samples);
  options.point_samples = static_cast<unsigned>(settings.point_samples);
  options.epsilon = static_cast<float>(settings.epsilon);
  options.most_rays = most_vmap_rays(settings, points);
  options.seed = scene.seed;
  options.thesis = settings.vmap == "thesis";
  return options;
}

} // namespace

std::uint64_t most_vmap_rays(const RadiositySettings& settings, std::size_t points) {
  return settings.vmap_rays ? static_cast<std::uint64_t>(*settings.vmap_rays) : default_vmap_rays(points, settings);
}

RadiosityMap cluster_points(Session& session, const ExchangeScene& scene, const RadiositySettings& settings) {
  RadiosityMap map;
  const std::vector<std::uint32_t> places = exchanging_points(scene);
  const bool all = places.size() == scene.points.size; // which are not copied
  const std::vector<Splat> some = all ? std::vector<Splat>() : points_at(scene, places);
  const View<Splat> points = all ? scene.points : View<Splat>(some);
  const auto ask = [&](View<Splat> ends, View<Segment> segments) {
    return DeviceVisibility(session, scene.pools, scene.variant, ends, step_delta_of(scene)).blocked(segments);
  };
  std::vector<std::uint32_t> parts;
  if (settings.vmap != "thesis") parts = parts_of_faces(points, ask);
  map.tree = build_clusters(points, ClusterOptions{}, parts);
  map.place.reserve(places.size());
  for (const std::uint32_t k : map.tree.order)
    map.place.push_back(places[k]);
  return map;
}

LinkEstimate estimate_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                                 const RadiosityMap& clusters) {
  if (clusters.place.empty()) return {};
  DeviceVisibility oracle(session, scene.pools, scene.variant, clusters.tree.points, step_delta_of(scene));
  return estimate_links(clusters.tree, oracle, link_options(scene, settings, clusters.place.size()), scene.points);
}

RadiosityMap find_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                             RadiosityMap map, std::optional<LinkEstimate> expected, const WorkReport& report) {
  if (map.place.empty()) return map;
  const TraversalVariant& variant = scene.variant;
  DeviceVisibility oracle(session, scene.pools, variant, map.tree.points, step_delta_of(scene));
  const LinkOptions options = link_options(scene, settings, map.place.size());
  const DeviceInfo& device = session.info();
  ReportedVisibility reported(
      oracle,
      [&] {
        if (!expected) expected = estimate_links(map.tree, oracle, options, scene.points);
        return options.most_rays > 0 ? std::min(expected->rays, static_cast<double>(options.most_rays))
                                     : expected->rays;
      },
      report);
  char more[80];
  std::snprintf(more, sizeof more, ", delta %a, kernels %016llx",
                variant.stepping == Stepping::absolute_delta ? variant.step_delta / scene.side : 0.0,
                static_cast<unsigned long long>(fnv1a(kernel_source(segments_program(variant).file))));
  map.vmap = kept_or_made_links(map.tree, scene.points, reported, options,
                                device.name + ", " + device.driver + ", " + name_of(variant) + more, &map.kept);
  return map;
}

RadiosityMap map_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                            const WorkReport& report) {
  return find_visibility(session, scene, settings, cluster_points(session, scene, settings), {}, report);
}

} // namespace pointgi
