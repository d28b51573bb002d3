#include "octree/pack/pools.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

WidePools pack(const std::vector<Splat>& splats, unsigned leaf_capacity, unsigned lanes,
               PointOrder order = PointOrder::morton, const SplatClips& clips = {}, const PatchBends& bends = {}) {
  TreeOptions options;
  options.order = order;
  options.leaf_capacity = leaf_capacity;
  options.listing = Listing::centres;
  return pack_wide(splats, build_tree(splats, options, bends), lanes, clips, bends);
}

} // namespace

TEST_CASE("the wide form obeys its invariants") {
  const unsigned lanes = GENERATE(8u, 16u), capacity = GENERATE(1u, 8u, 64u);
  const auto order = GENERATE(PointOrder::morton, PointOrder::hilbert);
  CHECK_NOTHROW(verify(pack(mixed_splats(), capacity, lanes, order)));
  CHECK_NOTHROW(verify(pack({}, capacity, lanes, order)));
  CHECK_NOTHROW(verify(pack({make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f)}, capacity, lanes, order)));
  // More in one place than a leaf's reference can count: cut into nodes, within the traversal's stack.
  CHECK_NOTHROW(
      verify(pack(std::vector<Splat>(100'000, make_splat(0.3f, 0.3f, 0.3f, 0, 1, 0, 1e-9f)), capacity, lanes, order)));
}

TEST_CASE("blocks know the borders of their splats, wherever these come to lie") {
  const unsigned lanes = GENERATE(8u, 16u);
  const auto splats = mixed_splats();
  const SplatClips clips = numbered_clips(splats.size());
  const WidePools pools = pack(splats, 8, lanes, PointOrder::hilbert, clips);
  CHECK_NOTHROW(verify(pools));
  REQUIRE(pools.clips.size() == clips.size());
  for (const ClippedSplat& c : pools.clips)
    REQUIRE(c.clip.strip[0].high == static_cast<float>(pools.source[c.splat]));
  CHECK(pools.blocks.size() == pack(splats, 8, lanes, PointOrder::hilbert).blocks.size() + CLIP_WORDS * clips.size());
}

TEST_CASE("blocks know the bends of their patches, and boxes hold them") {
  const unsigned lanes = GENERATE(8u, 16u);
  const auto splats = mixed_splats();
  const PatchBends bends = random_bends(splats, 3);
  WidePools pools = pack(splats, 8, lanes, PointOrder::hilbert, numbered_clips(splats.size()), bends);
  CHECK_NOTHROW(verify(pools));
  for (std::size_t i = 0; i < splats.size(); ++i)
    REQUIRE(pools.bends[i].xy == bends[pools.source[i]].xy);
  SECTION("a bend that differs") {
    pools.blocks[WIDE_BEND(lanes, 1)] += 1.0f;
    CHECK_THROWS_AS(verify(pools), std::logic_error);
  }
  SECTION("boxes of discs alone") {
    WidePools flat = pack(splats, 8, lanes, PointOrder::hilbert, numbered_clips(splats.size()));
    pools.nodes = flat.nodes;
    CHECK_THROWS_AS(verify(pools), std::logic_error);
  }
}

TEST_CASE("the wide form's verifier finds each planted fault") {
  WidePools pools = pack(sphere_splats(600), 8, 8, PointOrder::morton, numbered_clips(600));
  SECTION("a clip that differs") {
    pools.blocks.back() += 1.0f;
  }
  SECTION("a clip of another point") {
    ++pools.clips[7].splat;
  }
  SECTION("a box that is too small") {
    pools.nodes[0].high[0][0] -= 0.1f;
  }
  SECTION("a child before its parent") {
    pools.nodes[1].child[0] = 1;
  }
  SECTION("a child outside the pool") {
    pools.nodes[0].child[0] = 1u << 20;
  }
  SECTION("a lost leaf") {
    pools.nodes.back().child[0] = 0;
  }
  SECTION("points along another curve") {
    pools.order = PointOrder::hilbert;
  }
  SECTION("a point that moved") {
    pools.points[300].position[1] += 0.01f;
  }
  SECTION("a point that grew") {
    pools.points[300].radius *= 2.0f;
  }
  CHECK_THROWS_AS(verify(pools), std::logic_error);
}

TEST_CASE("the wide form takes at most 90 bytes a splat at its default capacity") {
  const auto splats = sphere_splats(100'000);
  // 48 of the point itself, 32 a lane of which four in five are used, and a node for every 80 splats.
  const OctreeSummary octree = summary_of(pack(splats, 64, 8));
  CHECK(octree.points == splats.size());
  CHECK(static_cast<double>(octree.bytes) / static_cast<double>(octree.points) <= 90.0);
}

TEST_CASE("trees that the wide form cannot take are refused") {
  const auto splats = sphere_splats(50);
  CHECK_THROWS_AS(pack_wide(splats, build_tree(splats, {}), 8), std::invalid_argument);
  TreeOptions options;
  options.listing = Listing::centres;
  CHECK_THROWS_AS(pack_wide(splats, build_tree(splats, options), 5), std::invalid_argument);
}
