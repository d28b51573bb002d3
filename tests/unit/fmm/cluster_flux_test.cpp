#include "fmm/operators/fmm_operator.h"
#include "fmm/ref/direct_sum.h"
#include "tests/support/exchange.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// The outside of a cube of side 0.1 about (0.2, 0.2, 0.2), and a small sheet at (0.8, 0.75, 0.7) that faces it.
std::vector<Splat> cube_and_sheet() {
  std::vector<Splat> splats = inside_cube(10, 0.1);
  for (Splat& s : splats)
    for (int a = 0; a < 3; ++a) {
      s.position[a] -= 0.3f;
      s.normal[a] = -s.normal[a];
    }
  const double n = std::sqrt(1.0 / 3.0), u = std::sqrt(0.5), v = std::sqrt(1.0 / 6.0);
  add_quad(splats, 4, {0.8, 0.75, 0.7}, {0.01 * u, -0.01 * u, 0.0}, {0.01 * v, 0.01 * v, -0.02 * v}, {-n, -n, -n},
           1e-4);
  return splats;
}

} // namespace

TEST_CASE("a cube seen from afar sends what its faces do, which as one flux would cancel") {
  const ClusterTree tree = build_clusters(cube_and_sheet(), {});
  REQUIRE(tree.nodes[0].child_count == 2);
  const std::uint32_t cube = tree.nodes[0].first_child, sheet = cube + 1;
  REQUIRE(tree.nodes[cube].count == 600);
  const FluxSides sides = flux_sides(tree);
  CHECK(sides.begin[cube + 1] - sides.begin[cube] == 6);
  CHECK(sides.begin[sheet + 1] - sides.begin[sheet] == 1);

  std::vector<double> b(3 * tree.points.size(), 0.0);
  for (std::size_t i = 0; i < 600; ++i) {
    b[3 * i] = 1.0;
    b[3 * i + 1] = tree.points[i].normal[0] > 0.5f ? 1.0 : 0.0;  // one of the three faces that are seen
    b[3 * i + 2] = tree.points[i].normal[0] < -0.5f ? 1.0 : 0.0; // one that is not
  }
  FmmOperator exchange(tree, std::vector<Link>{{cube, sheet, 1.0f, LinkKind::mid, no_point_shares}}, {}, {});
  std::vector<double> h;
  exchange.apply(b, LinearisationPoint::current, h);
  std::vector<std::uint32_t> receivers;
  for (std::uint32_t i = 600; i < tree.points.size(); ++i)
    receivers.push_back(i);
  const std::vector<double> truth = direct_sum(tree.points, b, receivers);
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    CAPTURE(k);
    // A face of side 0.1 as a point at a distance of 0.95: of the order of (0.05 / 0.95)^2.
    CHECK(h[3 * receivers[k]] == Approx(truth[3 * k]).epsilon(5e-3));
    CHECK(h[3 * receivers[k] + 1] == Approx(truth[3 * k + 1]).epsilon(5e-3));
    CHECK(truth[3 * k + 2] == 0.0);
    CHECK(h[3 * receivers[k] + 2] == 0.0);
  }
}

TEST_CASE("what lies nearly flat has one flux, the whole of a ball six") {
  const ClusterTree flat = build_clusters(facing_sheets(20), {});
  const FluxSides sides = flux_sides(flat);
  CHECK(sides.begin[1] == 2); // the root holds both: up and down
  for (std::size_t k = 1; k < flat.nodes.size(); ++k)
    if (flat.nodes[k].cone < 0.1f) CHECK(sides.side[sides.begin[k]] == all_sides);
  const ClusterTree ball = build_clusters(inside_sphere(3000), {});
  CHECK(flux_sides(ball).begin[1] == 6);
}
