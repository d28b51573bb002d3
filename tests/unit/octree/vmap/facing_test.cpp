#include "octree/vmap/facing.h"
#include "octree/vmap/pair_samples.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// Least and largest cosine of n_a against the way to b over all pairs of points; what is more, n_a.(b-a).
struct Range {
  double least_cosine = 2.0, most_cosine = -2.0;
};

Range range_of(const ClusterTree& tree, const Cluster& a, const Cluster& b) {
  Range range;
  for (std::uint32_t i = 0; i < a.count; ++i)
    for (std::uint32_t j = 0; j < b.count; ++j) {
      const Splat &x = tree.points[a.first_point + i], &y = tree.points[b.first_point + j];
      double along = 0.0, d2 = 0.0;
      for (int k = 0; k < 3; ++k) {
        const double d = static_cast<double>(y.position[k]) - x.position[k];
        along += d * x.normal[k];
        d2 += d * d;
      }
      range.least_cosine = std::min(range.least_cosine, along / std::sqrt(d2));
      range.most_cosine = std::max(range.most_cosine, along / std::sqrt(d2));
    }
  return range;
}

} // namespace

TEST_CASE("facing holds for every pair of points that it speaks for") {
  const auto splats = room_splats(1500);
  const ClusterTree tree = build_clusters(splats, {});
  std::size_t all = 0, none = 0, some = 0, could_be_all = 0, could_be_none = 0;
  for (std::size_t p = 0; p < tree.nodes.size(); ++p)
    for (std::size_t q = p % 3; q < tree.nodes.size(); q += 3) {
      const Cluster &a = tree.nodes[p], &b = tree.nodes[q];
      if (p == q || a.count > 200 || b.count > 200) continue;
      const Facing f = facing(a, b);
      const Range range = range_of(tree, a, b);
      all += f == Facing::all;
      none += f == Facing::none;
      some += f == Facing::some;
      if (f == Facing::all) REQUIRE(range.least_cosine > 0.0);
      // What it forgets: 1e-5 of the pair's greatest distance and 2e-7, over distances of 1e-3 and more.
      if (f == Facing::none) REQUIRE(range.most_cosine < 1e-3);
      could_be_all += range.least_cosine > 0.0;
      could_be_none += range.most_cosine < 1e-5;
    }
  CHECK(some > 0);
  // Bounds that say nothing would pass above: most of what is so is known to be so, the bumpy body included.
  CHECK(static_cast<double>(all) > 0.75 * static_cast<double>(could_be_all));
  CHECK(static_cast<double>(none) > 0.5 * static_cast<double>(could_be_none));
}

TEST_CASE("perpendicular walls face each other, a flat wall does not see itself") {
  std::vector<Splat> splats;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const float u = 0.2f + 0.03f * static_cast<float>(i), v = 0.2f + 0.03f * static_cast<float>(j);
      splats.push_back(make_splat(u, v, 0.1f, 0, 0, 1, 0.02f)); // a floor
      splats.push_back(make_splat(0.1f, u, v, 1, 0, 0, 0.02f)); // a wall
    }
  const ClusterTree tree = build_clusters(splats, {});
  std::size_t walls = 0, same = 0;
  for (const Cluster& a : tree.nodes)
    for (const Cluster& b : tree.nodes) {
      if (&a == &b || a.cone > 1e-3f || b.cone > 1e-3f) continue; // of one wall each
      if (a.axis[2] > 0.5f && b.axis[0] > 0.5f) {
        ++walls;
        REQUIRE(facing(a, b) == Facing::all);
        REQUIRE(facing(b, a) == Facing::all);
      } else if (a.axis[2] > 0.5f && b.axis[2] > 0.5f) {
        ++same;
        REQUIRE(facing(a, b) == Facing::none);
      }
    }
  CHECK(walls > 100);
  CHECK(same > 100);
}

TEST_CASE("the bound of what clusters exchange holds where they are small against their distance") {
  const auto splats = room_splats(1500);
  const ClusterTree tree = build_clusters(splats, {});
  std::size_t tested = 0;
  for (std::size_t p = 0; p < tree.nodes.size(); ++p)
    for (std::size_t q = p + 1; q < tree.nodes.size(); q += 5) {
      const Cluster &a = tree.nodes[p], &b = tree.nodes[q];
      if (!well_separated(a, b, 0.25f) || a.count > 200 || b.count > 200) continue;
      ++tested;
      // Irradiance at a's points of all of b at unit radiosity.
      double most = 0.0;
      for (std::uint32_t i = 0; i < a.count; ++i) {
        double sum = 0.0;
        for (std::uint32_t j = 0; j < b.count; ++j) {
          const Splat &x = tree.points[a.first_point + i], &y = tree.points[b.first_point + j];
          if (!face_each_other(x, y)) continue;
          double at_x = 0.0, at_y = 0.0, d2 = 0.0;
          for (int k = 0; k < 3; ++k) {
            const double d = static_cast<double>(y.position[k]) - x.position[k];
            at_x += d * x.normal[k];
            at_y -= d * y.normal[k];
            d2 += d * d;
          }
          sum += at_x * at_y * y.area / (3.14159265 * d2 * d2);
        }
        most = std::max(most, sum);
      }
      // D is that of the centres; points may be nearer by a quarter of it: 1/0.75².
      REQUIRE(most <= 1.78 * exchange_bound(a, b));
    }
  CHECK(tested > 1000);
}

TEST_CASE("clusters are well separated where their spheres leave a gap") {
  Cluster a{}, b{};
  a.radius = 0.1f;
  b.radius = 0.2f;
  b.centre[0] = 0.5f;
  CHECK(well_separated(a, b, 0.61f));
  CHECK_FALSE(well_separated(a, b, 0.59f));
  b.centre[0] = 0.0f; // in one place
  CHECK_FALSE(well_separated(a, b, 1.0f));
}
