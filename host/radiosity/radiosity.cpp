#include "host/radiosity/radiosity.h"
#include "host/cache/binary_cache.h"
#include "host/cache/vmap_cache.h"
#include "host/cl/kernel_source.h"
#include "host/passes/visibility.h"
#include "host/radiosity/direct.h"
#include "host/radiosity/fmm.h"
#include <cstdio>
#include <stdexcept>

namespace pointgi {

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

/// Passes applies on and reports how many were made.
class ReportedExchange : public RadiosityOperator {
public:
  ReportedExchange(RadiosityOperator& exchange, const WorkReport& report) : exchange_(exchange), report_(report) {}

  std::size_t points() const override { return exchange_.points(); }
  void apply(View<double> radiosity, Judge judge, std::vector<double>& irradiance) override {
    exchange_.apply(radiosity, judge, irradiance);
    report_(std::to_string(++applies_) + " applies of the operator");
  }

private:
  RadiosityOperator& exchange_;
  const WorkReport& report_;
  unsigned applies_ = 0;
};

/// Places in the pool of the points that send and receive light.
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

/// The tree over them, and their places in its order.
void cluster(const ExchangeScene& scene, RadiosityMap& map) {
  const std::vector<std::uint32_t> places = exchanging_points(scene);
  map.tree = build_clusters(points_at(scene, places), ClusterOptions{});
  for (const std::uint32_t k : map.tree.order)
    map.place.push_back(places[k]);
}

} // namespace

RadiosityMap map_visibility(Session& session, const ExchangeScene& scene, const RadiositySettings& settings,
                            const WorkReport& report) {
  RadiosityMap map;
  cluster(scene, map);
  if (map.place.empty()) return map;
  const TraversalVariant& variant = scene.variant;
  DeviceVisibility oracle(session, scene.pools, variant, map.tree.points,
                          static_cast<float>(variant.step_delta / scene.side));
  LinkOptions options;
  options.samples = static_cast<unsigned>(settings.vmap_samples);
  options.point_samples = static_cast<unsigned>(settings.point_samples);
  options.epsilon = static_cast<float>(settings.epsilon);
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

namespace {

/// The points that exchange light, and where each stands in the pool.
struct ExchangedPoints {
  View<Splat> points;
  View<std::uint32_t> place;
};

void check_sizes(View<std::uint32_t> place, const EnteringLight& light) {
  for (const std::uint32_t p : place)
    if (3 * (static_cast<std::size_t>(p) + 1) > light.direct.size)
      throw std::invalid_argument("radiosity: three direct irradiances a point of the pool");
  if (light.emitted.size != 0 && light.emitted.size != light.direct.size)
    throw std::invalid_argument("radiosity: emission of all points of the pool, or of none");
}

RadiosityField solve_field(RadiosityOperator& device, const ExchangedPoints& exchanged, const EnteringLight& light,
                           const RadiositySettings& settings, const WorkReport& report) {
  const std::size_t points = exchanged.points.size;
  std::vector<double> emission(3 * points), albedo(3 * points), area(points);
  for (std::size_t k = 0; k < points; ++k) {
    const Splat& splat = exchanged.points[k];
    area[k] = splat.area;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = 3 * exchanged.place[k] + c;
      albedo[3 * k + c] = splat.colour[c];
      emission[3 * k + c] = splat.colour[c] * light.direct[at] + (light.emitted.size != 0 ? light.emitted[at] : 0.0f);
    }
  }
  ReportedExchange exchange(device, report);
  SolveOptions solve;
  solve.tolerance = settings.tolerance;
  RadiosityField field;
  field.solution = solve_radiosity(exchange, emission, albedo, area, solve);
  std::vector<double> gathered;
  exchange.apply(field.solution.radiosity, Judge::now, gathered);
  field.irradiance.resize(light.direct.size);
  for (std::size_t k = 0; k < points; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      field.irradiance[3 * exchanged.place[k] + c] = static_cast<float>(gathered[3 * k + c]);
  return field;
}

/// Of a pool in which nothing exchanges light.
RadiosityField dark_field(const EnteringLight& light) {
  RadiosityField field;
  field.irradiance.resize(light.direct.size);
  field.solution.end = SolveEnd::converged;
  return field;
}

} // namespace

RadiosityField solve_radiosity_field(Session& session, const RadiosityMap& map, const EnteringLight& light,
                                     const RadiositySettings& settings, const WorkReport& report) {
  check_sizes(map.place, light);
  if (map.place.empty()) return dark_field(light);
  FmmOptions options;
  options.grid.order = static_cast<unsigned>(settings.order);
  DeviceFmm exchange(session, map.tree, map.vmap.links, options, map.vmap.point_shares);
  RadiosityField field = solve_field(exchange, {map.tree.points, map.place}, light, settings, report);
  field.counts = count_exchanges(map.tree, exchange.lists());
  field.rays = map.vmap.statistics.rays;
  return field;
}

RadiosityField solve_radiosity_directly(Session& session, const ExchangeScene& scene, const EnteringLight& light,
                                        const RadiositySettings& settings, const WorkReport& report) {
  // The pool's order keeps close points together.
  const std::vector<std::uint32_t> places = exchanging_points(scene);
  check_sizes(places, light);
  if (places.empty()) return dark_field(light);
  const std::vector<Splat> points = points_at(scene, places);
  DirectOptions options;
  options.step_delta = static_cast<float>(scene.variant.step_delta / scene.side);
  options.progress = [&](double share) { report(std::to_string(static_cast<int>(100.0 * share)) + " % of the rays"); };
  DeviceDirect exchange(session, scene.pools, scene.variant, points, options);
  RadiosityField field = solve_field(exchange, {points, places}, light, settings, report);
  field.rays = exchange.rays();
  return field;
}

} // namespace pointgi
