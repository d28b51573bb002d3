#include "host/photon/specular_leaves.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;

namespace {

constexpr double pi = 3.14159265358979;

Splat splat_at(double x, double y, double z, const double (&normal)[3], double radius, int material) {
  Splat s{};
  s.position[0] = static_cast<float>(x), s.position[1] = static_cast<float>(y), s.position[2] = static_cast<float>(z);
  for (int a = 0; a < 3; ++a)
    s.normal[a] = static_cast<float>(normal[a]);
  s.radius = static_cast<float>(radius);
  s.area = static_cast<float>(pi * radius * radius);
  s.material = static_cast<float>(material);
  return s;
}

/// A flat square of 40 x 40 splats of material 1, a ball of 500 of material 2, and 100 of material 0 between them.
std::vector<Splat> some_splats() {
  std::vector<Splat> points;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      points.push_back(splat_at(0.1 + 0.01 * i, 0.1, 0.1 + 0.01 * j, {0.0, 1.0, 0.0}, 0.008, 1));
  for (int i = 0; i < 100; ++i)
    points.push_back(splat_at(0.005 * i, 0.5, 0.5, {0.0, 0.0, 1.0}, 0.01, 0));
  for (int i = 0; i < 500; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / 500.0, r = std::sqrt(1.0 - z * z), phi = 2.39996323 * i;
    const double n[3] = {r * std::cos(phi), r * std::sin(phi), z};
    points.push_back(splat_at(0.7 + 0.1 * n[0], 0.7 + 0.1 * n[1], 0.7 + 0.1 * n[2], n, 0.011, 2));
  }
  return points;
}

bool is_specular(const Splat& s) {
  return s.material != 0.0f;
}

} // namespace

TEST_CASE("specular leaves hold each specular splat once, within their spheres") {
  const std::vector<Splat> points = some_splats();
  for (const bool all_small : {false, true})
    for (const std::size_t most : {std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
      CAPTURE(all_small, most);
      const SpecularLeaves leaves = specular_leaves(points, is_specular, most, all_small);
      CHECK(leaves.leaves.size() <= most);
      CHECK(leaves.splats.size() == 2100);
      REQUIRE(leaves.leaf_of.size() == points.size());
      std::vector<int> seen(points.size());
      for (std::size_t k = 0; k < leaves.leaves.size(); ++k) {
        const PhotonLeaf& leaf = leaves.leaves[k];
        double area = 0.0;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
          const Splat& s = points[leaves.splats[i]];
          ++seen[leaves.splats[i]];
          REQUIRE(leaves.leaf_of[leaves.splats[i]] == k);
          REQUIRE(std::hypot(s.position[0] - leaf.centre[0], s.position[1] - leaf.centre[1],
                             s.position[2] - leaf.centre[2]) +
                      s.radius <=
                  leaf.radius);
          area += double{s.area};
        }
        const float* axis = &leaves.axis[3 * k];
        CHECK(std::hypot(axis[0], axis[1], axis[2]) == Approx(1.0).epsilon(1e-5));
        CHECK(leaves.area[k] == Approx(area).epsilon(1e-5));
      }
      for (std::size_t p = 0; p < points.size(); ++p) {
        REQUIRE(seen[p] == (is_specular(points[p]) ? 1 : 0));
        REQUIRE((leaves.leaf_of[p] == NO_PHOTON_LEAF) == !is_specular(points[p]));
      }
    }
}

TEST_CASE("a ball is one leaf, a flat mirror many, and both are many where all are to be small") {
  const std::vector<Splat> points = some_splats();
  const auto of_material = [&](float material, bool all_small) {
    const auto chosen = [&](const Splat& s) { return s.material == material; };
    return specular_leaves(points, chosen, 1000, all_small);
  };
  CHECK(of_material(1.0f, false).leaves.size() > 4);
  CHECK(of_material(2.0f, false).leaves.size() == 1);
  CHECK(of_material(1.0f, true).leaves.size() >= 40);
  CHECK(of_material(2.0f, true).leaves.size() >= 10);
  for (std::size_t k = 0; k < of_material(1.0f, false).leaves.size(); ++k)
    CHECK(of_material(1.0f, false).axis[3 * k + 1] == Approx(1.0).epsilon(1e-5));
}

TEST_CASE("without specular splats there are no leaves") {
  const SpecularLeaves leaves = specular_leaves(
      some_splats(), [](const Splat&) { return false; }, 10, false);
  CHECK(leaves.leaves.empty());
  CHECK(leaves.leaf_of == std::vector<std::uint32_t>(2200, NO_PHOTON_LEAF));
  CHECK(specular_leaves({}, is_specular, 10, false).leaf_of.empty());
}
