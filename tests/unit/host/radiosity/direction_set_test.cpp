/// Sets of directions over the hemisphere, against the cosine law that they share out.
#include "host/radiosity/direction_set.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace pointgi;

TEST_CASE("stratified directions: so many cells as asked for, alike in size, that fill the square without overlap") {
  for (const unsigned count : {1u, 2u, 3u, 7u, 64u, 256u, 512u, 1000u, 1024u}) {
    const DirectionSet set = direction_set(DirectionPattern::stratified, count);
    CAPTURE(count);
    REQUIRE(set.cells.size() == count);
    REQUIRE(set.weights.size() == count);
    for (unsigned k = 0; k < count; ++k) {
      CHECK(set.weights[k] == Approx(1.0 / count));
      CHECK(set.cells[k][1] * set.cells[k][3] ==
            Approx(1.0 / count)); // the density of cosine_direction is even in u, v
    }
    std::mt19937 g(count);
    std::uniform_real_distribution<float> inside(0.0f, 1.0f);
    for (int i = 0; i < 500; ++i) {
      const float u = inside(g), v = inside(g);
      int holding = 0; // borders may round into both or neither: places just beside them are not asked
      bool near_border = false;
      for (const auto& c : set.cells) {
        const float a = (u - c[0]) / c[1], b = (v - c[2]) / c[3];
        near_border = near_border ||
                      (std::min(std::fabs(a), std::fabs(a - 1.0f)) < 1e-4f && b > -1e-4f && b < 1.0001f) ||
                      (std::min(std::fabs(b), std::fabs(b - 1.0f)) < 1e-4f && a > -1e-4f && a < 1.0001f);
        holding += a >= 0.0f && a < 1.0f && b >= 0.0f && b < 1.0f;
      }
      if (!near_border) CHECK(holding == 1);
    }
  }
}

TEST_CASE("cells of the stratified set are about as wide as they are long") {
  const DirectionSet set = direction_set(DirectionPattern::stratified, 512);
  for (const auto& c : set.cells) {
    const double inner = std::sqrt(c[0]), outer = std::sqrt(c[0] + c[1]);
    const double across = outer - inner, along = 2.0 * 3.14159265 * 0.5 * (inner + outer) * c[3];
    if (inner > 0.2) CHECK(along / across == Approx(1.0).margin(0.2)); // the innermost rings have few sectors
  }
}

TEST_CASE("a hemicube's weights are the cosine law's share of each cell, and sum to 1") {
  for (const unsigned count : {12u, 300u, 1200u}) {
    const DirectionSet set = direction_set(DirectionPattern::hemicube, count);
    CAPTURE(count);
    REQUIRE(set.cells.size() == count); // 12 m²
    CHECK(std::accumulate(set.weights.begin(), set.weights.end(), 0.0) == Approx(1.0).epsilon(1e-6));
    // Each cell's share again, from directions drawn by the cosine that pass through it.
    const int half = static_cast<int>(std::lround(std::sqrt(count / 12.0)));
    std::vector<double> share(count, 0.0);
    const int draws = 1000; // a side of a grid
    for (int i = 0; i < draws; ++i)
      for (int j = 0; j < draws; ++j) {
        const double r = std::sqrt((i + 0.5) / draws), phi = 2.0 * 3.14159265358979 * (j + 0.5) / draws;
        const double d[3] = {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - r * r)};
        const double largest = std::max({std::fabs(d[0]), std::fabs(d[1]), d[2]});
        const auto cell = [&](double x) { return static_cast<int>(std::floor(x / largest * half)); };
        // The direction of the set that lies in the same cell of the cube.
        for (unsigned k = 0; k < count; ++k) {
          const auto& c = set.cells[k];
          const float top = std::max({std::fabs(c[0]), std::fabs(c[1]), c[2]});
          const auto of = [&](float x) { return static_cast<int>(std::floor(x / top * static_cast<float>(half))); };
          if (count != 12u) break; // the search is slow: the small cube is enough for the order of the cells
          if ((std::fabs(c[0]) == top) != (std::fabs(d[0]) == largest) || (c[2] == top) != (d[2] == largest)) continue;
          if (top == std::fabs(c[0]) ? c[0] * d[0] > 0 && of(c[1]) == cell(d[1]) && of(c[2]) == cell(d[2])
              : top == c[2]          ? of(c[0]) == cell(d[0]) && of(c[1]) == cell(d[1])
                                     : c[1] * d[1] > 0 && of(c[0]) == cell(d[0]) && of(c[2]) == cell(d[2])) {
            share[k] += 1.0 / (draws * draws);
            break;
          }
        }
      }
    if (count == 12u)
      for (unsigned k = 0; k < count; ++k)
        CHECK(share[k] == Approx(set.weights[k]).epsilon(0.01)); // a million directions on a grid: borders blur 0.1 %
  }
}
