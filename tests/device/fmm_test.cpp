/// The kernels of radiosity against their twin in double.
#include "fmm/ref/direct_sum.h"
#include "fmm/solve/solve.h"
#include "host/radiosity/fmm.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include <catch2/catch.hpp>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Links of all kinds and shares: every third far link becomes a mid one, every third link's points have shares of
/// their own, which are put into `shares`.
std::vector<Link> mixed_links(const ClusterTree& tree, std::vector<std::uint8_t>& shares) {
  auto links = links_without_visibility(tree);
  std::mt19937 random(7);
  for (Link& link : links) {
    if (link.kind == LinkKind::far && random() % 3 == 0) link.kind = LinkKind::mid;
    link.visible = random() % 2 == 0 ? 1.0f : 0.375f;
    if (random() % 3 != 0) continue;
    link.point_shares = static_cast<std::uint32_t>(shares.size());
    for (std::uint32_t k = 0; k < tree.nodes[link.a].count + tree.nodes[link.b].count; ++k)
      shares.push_back(static_cast<std::uint8_t>(random() % 256));
  }
  return links;
}

} // namespace

TEST_CASE("fmm on the device equals its twin", "[long]") {
  for (const auto& splats : {inside_sphere(3000), inside_cube(20), facing_sheets(30), mixed_splats()})
    for (unsigned order = 2; order <= 6; ++order) {
      CAPTURE(splats.size(), order);
      const ClusterTree tree = build_clusters(splats, {});
      std::vector<std::uint8_t> shares;
      const auto links = mixed_links(tree, shares);
      FmmOptions options;
      options.grid.order = order;
      options.lists.direct_below = order % 2 == 0 ? 0.0 : 1.5;
      FmmOperator twin(tree, links, options, shares);
      DeviceFmm device(session(), tree, links, options, shares);
      DeviceFmm lane_by_lane(gpu_session(), tree, links, options, shares);
      REQUIRE(device.points() == twin.points());
      const auto b = varied_radiosity(tree.points);
      std::vector<double> expected, h, h_of_lanes;
      twin.apply(b, LinearisationPoint::current, expected);
      device.apply(b, LinearisationPoint::current, h);
      lane_by_lane.apply(b, LinearisationPoint::current, h_of_lanes);
      // The same sums in the same order: quotients and cosines may round otherwise.
      CHECK(relative_l2(h_of_lanes, h) < 1e-6);
      // Float: 1e-7 of places in the cube is 1e-4 of the distance of the nearest splats, whose share is small.
      CHECK(relative_l2(h, expected) < 2e-5);
      double worst = 0.0, largest = 0.0;
      for (std::size_t k = 0; k < h.size(); ++k) {
        worst = std::max(worst, std::abs(h[k] - expected[k]));
        largest = std::max(largest, expected[k]);
      }
      CHECK(worst < 1e-3 * largest);

      // Linear once judged: both signs.
      std::vector<double> other(b.rbegin(), b.rend());
      for (std::size_t k = 0; k < other.size(); k += 2)
        other[k] = -other[k];
      twin.apply(other, LinearisationPoint::kept, expected);
      device.apply(other, LinearisationPoint::kept, h);
      CHECK(relative_l2(h, expected) < 5e-5);
      lane_by_lane.apply(other, LinearisationPoint::kept, h_of_lanes);
      CHECK(relative_l2(h_of_lanes, h) < 1e-6);
    }
}

TEST_CASE("fmm on the device: the same bits again, and a furnace") {
  const ClusterTree tree = build_clusters(inside_sphere(5000), {});
  const auto links = links_without_visibility(tree);
  DeviceFmm device(session(), tree, links, {});
  const auto b = varied_radiosity(tree.points);
  std::vector<double> first, again;
  device.apply(b, LinearisationPoint::current, first);
  DeviceFmm(session(), tree, links, {}).apply(b, LinearisationPoint::current, again);
  CHECK(first == again);
  device.apply(b, LinearisationPoint::current, again); // launches of another size by now
  CHECK(first == again);

  const std::vector<float> emission(b.size(), 1.0f), albedo(b.size(), 0.9f);
  std::vector<float> area;
  for (const Splat& s : tree.points)
    area.push_back(s.area);
  const Solution solution = solve_radiosity(device, emission, albedo, area, {});
  CHECK(solution.end == SolveEnd::converged);
  double mean = 0.0;
  for (const double value : solution.radiosity)
    mean += value / static_cast<double>(b.size());
  CHECK(mean == Approx(10.0).epsilon(0.01));
}

TEST_CASE("fmm time", "[.]") {
  for (const unsigned order : {2u, 3u, 4u, 5u}) {
    const ClusterTree tree = build_clusters(inside_sphere(100000), {});
    const auto links = links_without_visibility(tree);
    FmmOptions options;
    options.grid.order = order;
    DeviceFmm device(session(), tree, links, options);
    const auto b = varied_radiosity(tree.points);
    std::vector<double> h;
    const auto before = session().kernel_times();
    device.apply(b, LinearisationPoint::current, h);
    device.apply(b, LinearisationPoint::current, h);
    double node_pairs = 0;
    for (std::uint32_t k = 0; k < tree.nodes.size(); ++k)
      for (std::uint32_t e = device.lists().far.begin[k]; e < device.lists().far.begin[k + 1]; ++e)
        node_pairs += 1.0 * device.grids().of[k].count * device.grids().of[device.lists().far.source[e]].count;
    for (const auto& [name, time] : session().kernel_times()) {
      const auto it = before.find(name);
      WARN(order << " " << name << " " << 0.5 * (time.seconds - (it == before.end() ? 0.0 : it->second.seconds))
                 << " s, launches " << time.launches << " node pairs " << node_pairs);
    }
  }
}
