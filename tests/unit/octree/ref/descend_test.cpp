#include "octree/build/cell_key.h"
#include "octree/ref/descend.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("the thesis' worked example: N = 2, d = 2, p = (0.6, 0.4)") {
  const auto step = descend_step<2>({0.6f, 0.4f}, 2);
  CHECK(step.child == 1); // linearised x + 2y
  CHECK(step.inside[0] == Approx(0.2f).margin(1e-6));
  CHECK(step.inside[1] == Approx(0.8f).margin(1e-6));
}

TEST_CASE("the descent ends in the cell that holds the position") {
  const unsigned axis_bits = GENERATE(1u, 2u);
  const auto splats = mixed_splats();
  const StepPools pools = pack_step(splats, build_tree(splats, {axis_bits, 4, 21 / axis_bits}));
  for (std::uint32_t p = 0; p < pools.points.size(); ++p) {
    const float* at = pools.points[p].position;
    const OctreeNode leaf = descend(pools, {at[0], at[1], at[2]});
    REQUIRE(NODE_TYPE(leaf.header) == NODE_LEAF);
    const std::uint32_t begin = pools.begin_end[leaf.address];
    REQUIRE(p >= begin);
    REQUIRE(p < begin + leaf.count);
  }
}
