#include "octree/pack/step_pools.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <functional>

using namespace pointgi;
using namespace pointgi::test;

namespace {

StepPools sound_pools() {
  const auto splats = sphere_splats(600);
  return pack_step(splats, build_tree(splats, {1, 8, 21}), numbered_clips(600));
}

std::size_t first_of_type(const StepPools& pools, unsigned type) {
  for (std::size_t i = 0; i < pools.nodes.size(); ++i)
    if (NODE_TYPE(pools.nodes[i].header) == type && (type != NODE_LEAF || pools.nodes[i].extra > 1)) return i;
  return 0;
}

} // namespace

TEST_CASE("the verifier accepts what the packer makes") {
  CHECK_NOTHROW(verify(sound_pools()));
}

TEST_CASE("the Begin-End pool knows the borders of the splats, wherever these come to lie") {
  const StepPools pools = sound_pools();
  REQUIRE(pools.clips.size() == 120);
  for (const ClippedSplat& c : pools.clips)
    CHECK(c.clip.strip[0].high == static_cast<float>(pools.source[c.splat]));
  for (std::size_t i = 0; i < pools.points.size(); ++i)
    CHECK((pools.begin_end[i] == 0) == (pools.source[i] % 5 != 0));
}

TEST_CASE("cells list the patches that reach into them") {
  const auto splats = mixed_splats();
  const PatchBends bends = random_bends(splats, 3);
  StepPools pools = pack_step(splats, build_tree(splats, {1, 8, 21}, bends), {}, bends);
  CHECK_NOTHROW(verify(pools));
  for (std::size_t i = 0; i < splats.size(); ++i)
    REQUIRE(pools.bends[i].xx == bends[pools.source[i]].xx);
  SECTION("a tree of discs") {
    CHECK_THROWS_AS(verify(pack_step(splats, build_tree(splats, {1, 8, 21}), {}, bends)), std::logic_error);
  }
  SECTION("a point without a bend") {
    pools.bends.pop_back();
    CHECK_THROWS_AS(verify(pools), std::logic_error);
  }
}

TEST_CASE("the verifier finds each planted fault") {
  StepPools pools = sound_pools();
  const std::size_t leaf = first_of_type(pools, NODE_LEAF), empty = first_of_type(pools, NODE_EMPTY);
  OctreeNode& node = pools.nodes[leaf];
  SECTION("a clip of another point") {
    pools.begin_end[pools.clips[3].splat] = pools.begin_end[pools.clips[4].splat];
  }
  SECTION("a lost extra splat") {
    pools.begin_end[node.address + 1] = pools.begin_end[node.address + 2];
  }
  SECTION("an extra splat out of range") {
    pools.begin_end[node.address + 1] = 1u << 30;
  }
  SECTION("a shifted beginP") {
    ++pools.begin_end[node.address];
  }
  SECTION("a wrong closing entry") {
    ++pools.begin_end.back();
  }
  SECTION("a wrong level") {
    node.header += 1u << 24;
  }
  SECTION("a wrong count") {
    ++node.count;
  }
  SECTION("an unknown type") {
    node.header |= 3u << 30;
  }
  SECTION("a child block outside the pool") {
    pools.nodes[0].address = 1u << 30;
  }
  SECTION("a child block used twice") {
    pools.nodes[0].address = pools.nodes[first_of_type(pools, NODE_INTERNAL) + 8].address;
  }
  SECTION("a leaf called empty") {
    node = pools.nodes[empty];
  }
  SECTION("a point moved out of its cell") {
    pools.points[pools.points.size() / 2].position[0] += 0.25f;
  }
  SECTION("a splat grown into more cells") {
    pools.points[pools.points.size() / 2].radius *= 6.0f;
  }
  CHECK_THROWS_AS(verify(pools), std::logic_error);
}

TEST_CASE("memory a splat stays within what info promises") {
  const auto splats = sphere_splats(20'000);
  const StepPools pools = pack_step(splats, build_tree(splats, {}));
  // 48 bytes a point, and with overlapping discs and leaves of 32 about 3 extra splats and a tenth of a node each.
  CHECK(static_cast<double>(pools.bytes()) / static_cast<double>(splats.size()) <= 90.0);
}
