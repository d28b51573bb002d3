#include "host/passes/radiosity.h"
#include "host/passes/direct.h"
#include "host/passes/fmm.h"
#include "host/passes/visibility.h"
#include "host/passes/vmap_cache.h"
#include <numeric>
#include <stdexcept>

namespace pointgi {

RadiosityMap map_visibility(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                            View<Splat> points, const RadiositySettings& settings, unsigned seed, double side) {
  RadiosityMap map;
  map.tree = build_clusters(points, ClusterOptions{});
  DeviceVisibility oracle(session, pools, variant, map.tree.points, static_cast<float>(variant.step_delta / side));
  LinkOptions options;
  options.samples = static_cast<unsigned>(settings.vmap_samples);
  options.point_samples = static_cast<unsigned>(settings.point_samples);
  options.epsilon = static_cast<float>(settings.epsilon);
  options.seed = seed;
  const DeviceInfo& device = session.info();
  map.vmap = kept_or_made_links(map.tree, points, oracle, options,
                                device.name + ", " + device.driver + ", " + name_of(variant), &map.kept);
  return map;
}

namespace {

/// The points that exchange light, and where each stands in the pool.
struct ExchangedPoints {
  View<Splat> points;
  View<std::uint32_t> place;
};

RadiosityField solve_field(RadiosityOperator& exchange, const ExchangedPoints& exchanged, View<float> direct,
                           const RadiositySettings& settings) {
  const std::size_t points = exchanged.points.size;
  if (direct.size != 3 * points) throw std::invalid_argument("radiosity: three direct irradiances a point");
  std::vector<double> emission(3 * points), albedo(3 * points), area(points);
  for (std::size_t k = 0; k < points; ++k) {
    const Splat& splat = exchanged.points[k];
    area[k] = splat.area;
    for (std::size_t c = 0; c < 3; ++c) {
      albedo[3 * k + c] = splat.colour[c];
      emission[3 * k + c] = splat.colour[c] * direct[3 * exchanged.place[k] + c];
    }
  }
  SolveOptions solve;
  solve.tolerance = settings.tolerance;
  RadiosityField field;
  field.solution = solve_radiosity(exchange, emission, albedo, area, solve);
  std::vector<double> gathered;
  exchange.apply(field.solution.radiosity, Judge::now, gathered);
  field.irradiance.resize(3 * points);
  for (std::size_t k = 0; k < points; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      field.irradiance[3 * exchanged.place[k] + c] = static_cast<float>(gathered[3 * k + c]);
  return field;
}

} // namespace

RadiosityField solve_radiosity_field(Session& session, const RadiosityMap& map, View<float> direct,
                                     const RadiositySettings& settings) {
  FmmOptions options;
  options.grid.order = static_cast<unsigned>(settings.order);
  DeviceFmm exchange(session, map.tree, map.vmap.links, options, map.vmap.point_shares);
  RadiosityField field = solve_field(exchange, {map.tree.points, map.tree.order}, direct, settings);
  field.rays = map.vmap.statistics.rays;
  return field;
}

RadiosityField solve_radiosity_directly(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                        View<Splat> points, View<float> direct, const RadiositySettings& settings,
                                        double side) {
  DirectOptions options;
  options.step_delta = static_cast<float>(variant.step_delta / side);
  DeviceDirect exchange(session, pools, variant, points, options);
  std::vector<std::uint32_t> place(points.size); // the pool's order keeps close points together
  std::iota(place.begin(), place.end(), 0u);
  RadiosityField field = solve_field(exchange, {points, place}, direct, settings);
  field.rays = exchange.rays();
  return field;
}

} // namespace pointgi
