#include "host/radiosity/point_blocks.h"
#include "tests/support/clouds.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// The share of whole blocks in which some two normals are more than 60 degrees apart.
double mixed_blocks(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& places, std::size_t size) {
  std::size_t mixed = 0, blocks = 0;
  for (std::size_t begin = 0; begin + size <= places.size(); begin += size, ++blocks) {
    float least = 1.0f;
    for (std::size_t i = begin; i < begin + size; ++i)
      for (std::size_t j = begin; j < i; ++j) {
        const float *a = splats[places[i]].normal, *b = splats[places[j]].normal;
        least = std::min(least, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
      }
    mixed += least < 0.5f;
  }
  return static_cast<double>(mixed) / static_cast<double>(blocks);
}

/// The mean length of the diagonals of the blocks' bounds.
double width_of_blocks(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& places, std::size_t size) {
  double sum = 0.0;
  std::size_t blocks = 0;
  for (std::size_t begin = 0; begin + size <= places.size(); begin += size, ++blocks) {
    double square = 0.0;
    for (int a = 0; a < 3; ++a) {
      float low = splats[places[begin]].position[a], high = low;
      for (std::size_t i = begin; i < begin + size; ++i) {
        low = std::min(low, splats[places[i]].position[a]);
        high = std::max(high, splats[places[i]].position[a]);
      }
      square += (double{high} - low) * (double{high} - low);
    }
    sum += std::sqrt(square);
  }
  return sum / static_cast<double>(blocks);
}

} // namespace

TEST_CASE("blocks of points: every place once, and the same ones whatever the order was") {
  const auto splats = room_splats(1500);
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < splats.size(); i += 1 + i % 2)
    places.push_back(i);
  const auto blocks = in_blocks(splats, places, 16);
  CHECK(in_blocks(splats, {places.rbegin(), places.rend()}, 16) == blocks);
  auto sorted = blocks;
  std::sort(sorted.begin(), sorted.end());
  CHECK(sorted == places);
  for (std::size_t i = 1; i < blocks.size(); ++i)
    if (i % 16 != 0) CHECK(blocks[i - 1] < blocks[i]);
  CHECK(in_blocks(splats, {}, 16).empty());
  CHECK(in_blocks(splats, {7}, 16) == std::vector<std::uint32_t>{7});
}

TEST_CASE("blocks of points: they face about one way, the sides of sheets too") {
  for (const auto& splats : {room_splats(4000), sheet_splats(room_splats(2000))}) {
    std::vector<std::uint32_t> all(splats.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto blocks = in_blocks(splats, all, 16);
    const double after = mixed_blocks(splats, blocks, 16), width = width_of_blocks(splats, blocks, 16);
    std::shuffle(all.begin(), all.end(), std::mt19937(1));
    const double before = mixed_blocks(splats, all, 16), before_width = width_of_blocks(splats, all, 16);
    CAPTURE(splats.size(), before, after, before_width, width);
    CHECK(after < 0.3 * before); // those that span an edge of the room, of so few
    CHECK(width <
          0.3 * before_width); // 16 of 3,900 points on the walls of a room: a tenth of its width, and more at edges
  }
}
