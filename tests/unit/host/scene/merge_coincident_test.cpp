#include "host/scene/merge_coincident.h"
#include "tests/support/clouds.h"
#include <catch2/catch.hpp>
#include <numeric>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("splats in one place that face alike become one, while sides, materials and places stay apart") {
  std::vector<Splat> splats = {
      make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.10f), make_splat(0.2f, 0.5f, 0.5f, 0, 0, 1, 0.1f),
      make_splat(0.5f, 0.5f, 0.5f, 0, 0, -1, 0.1f), make_splat(0.5f, 0.5f, 0.5f, 0, 0.1f, 1, 0.2f),
      make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.10f)};
  splats[4].material = 1.0f;
  splats[3].colour[0] = 1.0f;
  const float area = splats[0].area + splats[3].area;
  std::vector<std::uint32_t> id = {10, 11, 12, 13, 14};
  const std::vector<MergedSplat> gone = merge_coincident(splats, id);
  REQUIRE(gone.size() == 1);
  CHECK(gone[0].id == 13);
  CHECK(gone[0].into == 10);
  CHECK(id == std::vector<std::uint32_t>{10, 11, 12, 14});
  CHECK(splats[0].area == Approx(area));
  CHECK(splats[0].radius == 0.2f);
  CHECK(splats[0].colour[0] == Approx(0.75f));
  CHECK(splats[0].normal[1] > 0.0f);
}

TEST_CASE("a hundred thousand splats in one place are one, and none of a sphere's goes") {
  std::vector<Splat> pile(100'000, make_splat(0.3f, 0.3f, 0.3f, 1, 0, 0, 0.1f));
  std::vector<std::uint32_t> id(pile.size());
  CHECK(merge_coincident(pile, id).size() == 99'999);
  auto sphere = sphere_splats(2000);
  const auto before = sphere;
  id.assign(sphere.size(), 0);
  CHECK(merge_coincident(sphere, id).empty());
  CHECK(sphere.size() == before.size());
}

TEST_CASE("points that end at borders are not merged, unless there are many in one place") {
  const auto pile = [](std::size_t count) {
    return std::vector<Splat>(count, make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.1f));
  };
  const auto left = [&](std::size_t count, const std::vector<bool>& alone) {
    std::vector<Splat> splats = pile(count);
    std::vector<std::uint32_t> id(count);
    std::iota(id.begin(), id.end(), 0u);
    merge_coincident(splats, id, nullptr, alone);
    return splats.size();
  };
  CHECK(left(4, {}) == 1);
  CHECK(left(4, {true, true, false, false}) == 3);
  CHECK(left(100'000, std::vector<bool>(100'000, true)) == 16);
}
