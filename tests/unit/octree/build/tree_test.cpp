#include "octree/build/tree.h"
#include "octree/pack/step_pools.h"
#include "tests/support/clouds.h"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A leaf by its place in the tree and by what it holds, whatever lies where in memory.
struct LeafContents {
  std::vector<unsigned> path; ///< child numbers from the root
  std::vector<std::uint32_t> own, extra;
  bool operator==(const LeafContents& o) const { return path == o.path && own == o.own && extra == o.extra; }
};

/// The leaves in the order of the child numbers.
void collect(const Tree& tree, const TreeNode& node, std::vector<unsigned> path, std::vector<LeafContents>& leaves) {
  if (node.first_child != 0) {
    for (unsigned c = 0; c < 8; ++c) {
      path.push_back(c);
      collect(tree, tree.nodes[node.first_child + c], path, leaves);
      path.pop_back();
    }
    return;
  }
  LeafContents leaf{path, {}, {}};
  for (std::uint32_t p = 0; p < node.count; ++p)
    leaf.own.push_back(tree.order[node.first_point + p]);
  for (std::uint32_t e = 0; e < node.extra_count; ++e)
    leaf.extra.push_back(tree.order[tree.extra[node.first_extra + e]]);
  std::sort(leaf.own.begin(), leaf.own.end());
  std::sort(leaf.extra.begin(), leaf.extra.end());
  leaves.push_back(leaf);
}

} // namespace

TEST_CASE("every tree obeys the invariants: branching, capacity, depth") {
  const unsigned axis_bits = GENERATE(1u, 2u), capacity = GENERATE(1u, 8u, 64u), depth = GENERATE(0u, 1u, 6u, 21u);
  const auto splats = mixed_splats();
  TreeOptions options{axis_bits, capacity, std::min(depth, 21u / axis_bits)};
  options.order = GENERATE(PointOrder::morton, PointOrder::hilbert);
  if (options.order == PointOrder::hilbert && axis_bits == 2) return; // refused
  const Tree tree = build_tree(splats, options);
  CHECK(tree.depth <= options.max_depth);
  Pool<std::uint32_t> order = tree.order;
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i)
    REQUIRE(order[i] == i);
  verify(pack_step(splats, tree));
}

TEST_CASE("degenerate clouds end with bounded depth") {
  std::vector<Splat> splats;
  SECTION("none") {}
  SECTION("one") {
    splats = {make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f)};
  }
  SECTION("two in one place") {
    splats.assign(2, make_splat(0.3f, 0.3f, 0.3f, 0, 0, 1, 0.01f));
  }
  SECTION("100,000 tiny ones in one place") {
    splats.assign(100'000, make_splat(0.3f, 0.3f, 0.3f, 0, 1, 1, 1e-9f));
  }
  SECTION("a line") {
    for (int i = 0; i < 500; ++i)
      splats.push_back(make_splat(0.1f + 0.0016f * static_cast<float>(i), 0.5f, 0.5f, 0, 0, 1, 0.001f));
  }
  SECTION("a dense dot and one far away") {
    splats = sphere_splats(2000, 1e-6f);
    splats.push_back(make_splat(0.01f, 0.01f, 0.01f, 0, 0, 1, 1e-7f));
  }
  const Tree tree = build_tree(splats, {1, 8, 21});
  CHECK(tree.depth <= 21);
  // A chain of 21 levels has 8 nodes a level; beyond that nodes must pay for themselves.
  CHECK(tree.nodes.size() < 400 + 40 * splats.size());
  verify(pack_step(splats, tree));
}

TEST_CASE("discs as large as the cells do not make the tree grow without end") {
  auto splats = random_splats(500, 4);
  for (Splat& s : splats)
    s.radius = 0.12f;
  const Tree tree = build_tree(splats, {1, 1, 21});
  // Dividing stops paying when a disc spans its cell: a few listings a splat for each halving down to there.
  CHECK(tree.extra.size() < 200 * splats.size());
}

TEST_CASE("options out of range are refused") {
  CHECK_THROWS_AS(build_tree({}, {3, 8, 5}), std::invalid_argument);
  CHECK_THROWS_AS(build_tree({}, {1, 0, 5}), std::invalid_argument);
  CHECK_THROWS_AS(build_tree({}, {1, 8, 22}), std::invalid_argument);
  CHECK_THROWS_AS(build_tree({}, {2, 8, 11}), std::invalid_argument);
  CHECK_THROWS_AS(build_tree({}, {2, 8, 5, Listing::overlaps, PointOrder::hilbert}), std::invalid_argument);
}

TEST_CASE("Hilbert's order has the leaves of Morton's") {
  // More splats than one task of the builder takes.
  auto splats = mixed_splats();
  const auto sphere = sphere_splats(12'000);
  splats.insert(splats.end(), sphere.begin(), sphere.end());
  TreeOptions options;
  options.leaf_capacity = GENERATE(4u, 64u);
  options.listing = GENERATE(Listing::overlaps, Listing::centres);
  std::vector<LeafContents> morton, hilbert;
  const Tree by_number = build_tree(splats, options);
  options.order = PointOrder::hilbert;
  const Tree along = build_tree(splats, options);
  collect(by_number, by_number.nodes[0], {}, morton);
  collect(along, along.nodes[0], {}, hilbert);
  CHECK(morton == hilbert);
  CHECK(by_number.depth == along.depth);
  CHECK(std::vector<std::uint32_t>(by_number.order.begin(), by_number.order.end()) !=
        std::vector<std::uint32_t>(along.order.begin(), along.order.end()));
}
