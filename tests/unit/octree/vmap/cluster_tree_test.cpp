#include "octree/vmap/cluster_tree.h"
#include "tests/support/clouds.h"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <omp.h>

using namespace pointgi;
using namespace pointgi::test;

namespace {

using Vec = std::array<double, 3>;

double dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec vec(const float v[3]) {
  return {v[0], v[1], v[2]};
}
double angle(const Vec& a, const Vec& b) {
  const Vec cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return std::atan2(std::sqrt(dot(cross, cross)), dot(a, b));
}

/// What a cluster says, again from its points alone, in the plainest way.
struct Twin {
  Vec low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9}, centre{}, axis{};
  double area = 0.0, radius = 0.0, cone = 0.0, low_along = 1e9, high_along = -1e9;
};

Twin twin_of(const ClusterTree& tree, const Cluster& c) {
  Twin t;
  for (std::uint32_t k = 0; k < c.count; ++k) {
    const Splat& s = tree.points[c.first_point + k];
    t.area += s.area;
    for (int a = 0; a < 3; ++a) {
      t.low[a] = std::min<double>(t.low[a], s.position[a]);
      t.high[a] = std::max<double>(t.high[a], s.position[a]);
      t.centre[a] += static_cast<double>(s.area) * s.position[a];
      t.axis[a] += static_cast<double>(s.area) * s.normal[a];
    }
  }
  const double length = std::sqrt(dot(t.axis, t.axis));
  for (int a = 0; a < 3; ++a) {
    t.centre[a] /= t.area;
    t.axis[a] /= length;
  }
  for (std::uint32_t k = 0; k < c.count; ++k) {
    const Splat& s = tree.points[c.first_point + k];
    const Vec p = vec(s.position), d{p[0] - t.centre[0], p[1] - t.centre[1], p[2] - t.centre[2]};
    t.radius = std::max(t.radius, std::sqrt(dot(d, d)));
    t.cone = std::max(t.cone, angle(t.axis, vec(s.normal)));
    t.low_along = std::min(t.low_along, dot(t.axis, p));
    t.high_along = std::max(t.high_along, dot(t.axis, p));
  }
  return t;
}

/// Structure alone: every point in one leaf, children adjacent and behind their parents and cutting their points.
void check_structure(const ClusterTree& tree, std::size_t points) {
  REQUIRE(tree.order.size() == points);
  REQUIRE(tree.points.size() == points);
  REQUIRE(tree.leaf_of.size() == points);
  CHECK(tree.nodes[0].parent == 0);
  CHECK(tree.nodes[0].level == 0);
  std::vector<int> in_leaves(points);
  std::size_t as_children = 1;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const Cluster& c = tree.nodes[n];
    if (c.first_child == 0) {
      REQUIRE(c.child_count == 0);
      for (std::uint32_t k = 0; k < c.count; ++k) {
        ++in_leaves[c.first_point + k];
        REQUIRE(tree.leaf_of[c.first_point + k] == n);
      }
      continue;
    }
    REQUIRE(c.first_child > n);
    std::uint32_t next = c.first_point;
    for (std::uint32_t k = 0; k < c.child_count; ++k) {
      const Cluster& child = tree.nodes[c.first_child + k];
      REQUIRE(child.parent == n);
      REQUIRE(child.level == c.level + 1);
      REQUIRE(child.count > 0);
      REQUIRE(child.first_point == next);
      next += child.count;
      ++as_children;
    }
    REQUIRE(next == c.first_point + c.count);
  }
  CHECK(as_children == tree.nodes.size());
  CHECK(std::all_of(in_leaves.begin(), in_leaves.end(), [](int k) { return k == 1; }));
}

void check_near(double found, double wanted, double tolerance) {
  REQUIRE(std::fabs(found - wanted) <= tolerance);
}

} // namespace

TEST_CASE("clusters say of their points what the points say") {
  const auto splats = GENERATE(mixed_splats(), sphere_splats(40'000)); // the latter has clusters cut between threads
  const ClusterTree tree = build_clusters(splats, {});
  check_structure(tree, splats.size());
  for (std::size_t k = 0; k < splats.size(); ++k)
    REQUIRE(std::memcmp(&tree.points[k], &splats[tree.order[k]], sizeof(Splat)) == 0);
  for (const Cluster& c : tree.nodes) {
    const Twin t = twin_of(tree, c);
    // Coordinates of about 1 in float: 6e-8 a rounding, a few of them.
    for (int a = 0; a < 3; ++a) {
      REQUIRE(c.low[a] == static_cast<float>(t.low[a]));
      REQUIRE(c.high[a] == static_cast<float>(t.high[a]));
      check_near(c.centre[a], t.centre[a], 2e-7);
    }
    check_near(c.area, t.area, 2e-7 * t.area);
    check_near(c.radius, t.radius, 3e-7);
    if (c.count > 20'000) continue; // of a whole sphere: the sum of the normals is the rounding of the sampling
    for (int a = 0; a < 3; ++a)
      check_near(c.axis[a], t.axis[a], 2e-7);
    check_near(c.cone, t.cone, 1e-6); // normals and axis of float: 1e-7 each
    check_near(c.low_along, t.low_along, 5e-7);
    check_near(c.high_along, t.high_along, 5e-7);
  }
}

TEST_CASE("what a cluster bounds holds for every point, exactly") {
  const ClusterTree tree = build_clusters(mixed_splats(), {});
  for (const Cluster& c : tree.nodes)
    for (std::uint32_t k = 0; k < c.count; ++k) {
      const Splat& s = tree.points[c.first_point + k];
      const Vec p = vec(s.position), centre = vec(c.centre), axis = vec(c.axis);
      const Vec d{p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]};
      REQUIRE(std::sqrt(dot(d, d)) <= c.radius);
      REQUIRE(dot(axis, p) >= c.low_along);
      REQUIRE(dot(axis, p) <= c.high_along);
      REQUIRE(angle(axis, vec(s.normal)) <= c.cone * (1.0 + 1e-12) + 1e-12); // the angle's own rounding in double
    }
}

TEST_CASE("leaves are small and near-planar, or have few points, or lie at the deepest level") {
  ClusterOptions options;
  options.leaf_capacity = GENERATE(1u, 4u, 32u, 200u);
  options.max_depth = GENERATE(0u, 5u, 21u);
  const auto splats = mixed_splats();
  const ClusterTree tree = build_clusters(splats, options);
  check_structure(tree, splats.size());
  std::size_t large_leaves = 0;
  for (const Cluster& c : tree.nodes) {
    REQUIRE(c.level <= options.max_depth);
    if (c.first_child != 0) {
      // Not divided without a reason.
      REQUIRE((c.count > options.leaf_capacity || (c.count > 8 && c.cone > options.planar_cone)));
      continue;
    }
    const bool deepest = c.level == options.max_depth;
    REQUIRE((deepest || c.count <= options.leaf_capacity));
    REQUIRE((deepest || c.count <= 8 || c.cone <= options.planar_cone));
    large_leaves += c.count > 8;
  }
  if (options.leaf_capacity >= 32) CHECK(large_leaves > 0); // planes end in leaves of their capacity
}

TEST_CASE("the two sides of a sheet have clusters of their own, as near-planar as those of one side") {
  const auto one_sided = plane_splats(20);
  std::vector<Splat> splats = sheet_splats(one_sided);
  splats.push_back(make_splat(0.8f, 0.8f, 0.8f, 0, 0, 1, 0.01f)); // of no sheet
  const ClusterTree tree = build_clusters(splats, {}), single = build_clusters(one_sided, {});
  check_structure(tree, splats.size());
  for (std::size_t k = 0; k < splats.size(); ++k)
    REQUIRE(std::memcmp(&tree.points[k], &splats[tree.order[k]], sizeof(Splat)) == 0);
  REQUIRE(tree.nodes[0].child_count == 2);
  const Cluster& backs = tree.nodes[2];
  CHECK(backs.count == one_sided.size());
  for (std::uint32_t k = 0; k < splats.size(); ++k)
    REQUIRE(is_back_of_sheet(tree.points[k]) == (k >= backs.first_point));
  const auto leaves = [](const ClusterTree& of) {
    return std::count_if(of.nodes.begin(), of.nodes.end(), [](const Cluster& c) { return c.first_child == 0; });
  };
  CHECK(leaves(tree) <= 2 * leaves(single) + 1);
  const Twin root = twin_of(tree, tree.nodes[0]);
  for (int a = 0; a < 3; ++a) {
    CHECK(tree.nodes[0].low[a] == static_cast<float>(root.low[a]));
    check_near(tree.nodes[0].centre[a], root.centre[a], 2e-7); // float, as above
  }
  check_near(tree.nodes[0].radius, root.radius, 3e-7);
}

TEST_CASE("the clusters do not depend on the number of threads") {
  const auto splats = sphere_splats(50'000);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const ClusterTree one = build_clusters(splats, {});
  omp_set_num_threads(3);
  const ClusterTree three = build_clusters(splats, {});
  omp_set_num_threads(threads);
  REQUIRE(one.nodes.size() == three.nodes.size());
  CHECK(std::memcmp(one.nodes.data(), three.nodes.data(), one.nodes.size() * sizeof(Cluster)) == 0);
  CHECK(one.order == three.order);
  CHECK(one.leaf_of == three.leaf_of);
}

TEST_CASE("clusters of next to nothing") {
  CHECK(build_clusters(View<Splat>(), {}).nodes.size() == 1);
  CHECK(build_clusters(View<Splat>(), {}).nodes[0].count == 0);
  const std::vector<Splat> one{make_splat(0.25f, 0.5f, 0.75f, 0, 0, -1, 0.1f)};
  const ClusterTree tree = build_clusters(one, {});
  REQUIRE(tree.nodes.size() == 1);
  CHECK(tree.nodes[0].radius == 0.0f);
  CHECK(tree.nodes[0].cone <= 1e-7f);
  CHECK(tree.nodes[0].axis[2] == -1.0f);
  // Both sides of a sheet: no mean normal.
  std::vector<Splat> sheet(2, one[0]);
  sheet[1].normal[2] = 1.0f;
  CHECK(build_clusters(sheet, {}).nodes[0].cone == Approx(3.14159265f));
  CHECK(build_clusters(sheet, {}).nodes[0].axis[2] == 1.0f);
  // Many in one place: a chain down to the deepest level, then a leaf.
  const std::vector<Splat> heap(3000, one[0]);
  check_structure(build_clusters(heap, {}), heap.size());
  CHECK(build_clusters(heap, {}).nodes.size() == 22);
}

TEST_CASE("options of clusters that make no sense are refused") {
  const auto splats = sphere_splats(10);
  ClusterOptions options;
  SECTION("capacity") {
    options.leaf_capacity = 0;
  }
  SECTION("depth") {
    options.max_depth = 22;
  }
  SECTION("cone") {
    options.planar_cone = 0.0f;
  }
  SECTION("no number") {
    options.planar_cone = std::numeric_limits<float>::quiet_NaN();
  }
  CHECK_THROWS_AS(build_clusters(splats, options), std::invalid_argument);
}
