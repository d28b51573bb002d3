/// Splats as voxels, and their pyramid, against dense samples of the discs and sums in double.
#include "host/radiosity/voxel_pyramid.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// The levels without their borders: of each, voxel after voxel, texel after texel.
std::vector<std::vector<cl_float4>> levels_of(const VoxelPyramid& pyramid) {
  const ConeGrid& grid = pyramid.grid();
  const std::vector<cl_float4> all = session().download(pyramid.voxels(), pyramid.voxels().size);
  std::vector<std::vector<cl_float4>> levels;
  for (pg_uint level = 0; level < CONE_GRID_LEVELS(&grid); ++level) {
    const std::size_t side = (1u << grid.side_log2) >> level, row = side + 2;
    std::vector<cl_float4> inside;
    std::size_t found = 0;
    for (std::size_t z = 0; z < row; ++z)
      for (std::size_t y = 0; y < row; ++y)
        for (std::size_t x = 0; x < row; ++x) {
          const auto within = [&](std::size_t a) { return a >= 1 && a <= side; };
          const std::size_t voxel = grid.first[level] + (z * row + y) * row + x;
          for (std::size_t t = 0; t < pyramid.texels(); ++t) {
            const cl_float4& texel = all[pyramid.texels() * voxel + t];
            if (within(x) && within(y) && within(z))
              inside.push_back(texel);
            else
              found += texel.s[0] != 0.0f || texel.s[1] != 0.0f || texel.s[2] != 0.0f || texel.s[3] != 0.0f;
          }
        }
    CHECK(found == 0); // borders stay empty
    levels.push_back(inside);
  }
  return levels;
}

std::vector<cl_float4> varied_light(std::size_t count) {
  std::vector<cl_float4> light;
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<float>(i);
    light.push_back({{1.0f + 0.5f * std::sin(t), 0.5f + 0.4f * std::cos(3.0f * t), -0.25f, 0.0f}});
  }
  return light;
}

/// Area of each voxel's surface, in sides of a voxel squared, by many samples of each disc, spread evenly.
std::vector<double> sampled_area(const std::vector<Splat>& splats, const ConeGrid& grid) {
  const long side = 1L << grid.side_log2;
  std::vector<double> area(static_cast<std::size_t>(side * side * side));
  constexpr int samples = 4000;
  for (const Splat& s : splats) {
    const Eigen::Vector3d n = Eigen::Vector3f(s.normal).cast<double>(), u = n.unitOrthogonal(), v = n.cross(u);
    for (int k = 0; k < samples; ++k) { // Vogel's spiral
      const double r = s.radius * std::sqrt((k + 0.5) / samples), angle = 2.399963229728653 * k;
      std::size_t number = 0;
      for (int a = 2; a >= 0; --a) {
        const double at = s.position[a] + r * (std::cos(angle) * u[a] + std::sin(angle) * v[a]);
        number = number * static_cast<std::size_t>(side) +
                 static_cast<std::size_t>(std::floor((at - grid.origin[a]) / grid.voxel));
      }
      area[number] += s.area / samples / (double{grid.voxel} * grid.voxel);
    }
  }
  return area;
}

} // namespace

TEST_CASE("a voxel's surface is what samples of the discs find in it") {
  std::vector<Splat> splats = random_splats(150, 7); // of a hundredth of a voxel to four voxels across
  splats.push_back(make_splat(0.5f, 0.5f, 0.5f, 0, 0, 1, 0.3f));
  splats.push_back(make_splat(0.4f, 0.6f, 0.5f, 1, 1, 1, 1e-6f));
  for (Splat& s : splats)
    s.area *= 0.8f; // discs overlap: the area is not that of the disc
  VoxelPyramid pyramid(session(), splats, {32, false});
  pyramid.inject(varied_light(splats.size()));
  const std::vector<cl_float4> finest = levels_of(pyramid).front();
  const std::vector<double> truth = sampled_area(splats, pyramid.grid());
  double all = 0.0, off = 0.0, sum = 0.0;
  std::size_t occupied = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    all += truth[k];
    sum += finest[k].s[3];
    off += std::fabs(finest[k].s[3] - truth[k]);
    occupied += finest[k].s[3] > 0.0f;
  }
  CHECK(sum == Approx(all).epsilon(1e-5)); // no share is lost, none counted twice
  // An octagon of a disc's area leaves out 2.1 % of the disc and has as much outside it; samples find 0.5 %.
  CHECK(off < 0.05 * all);
  CHECK(occupied == pyramid.occupied());
}

TEST_CASE("the flux of every level is the sum of B A over the splats") {
  const std::vector<Splat> splats = random_splats(400, 11);
  const std::vector<cl_float4> light = varied_light(splats.size());
  for (const bool anisotropic : {false, true}) {
    VoxelPyramid pyramid(session(), splats, {64, anisotropic});
    pyramid.inject(light);
    CHECK(pyramid.texels() == (anisotropic ? 6u : 1u));
    const double voxel = pyramid.grid().voxel, volume = voxel * voxel;
    double truth[6][4] = {};
    for (std::size_t i = 0; i < splats.size(); ++i)
      for (int side = 0; side < (anisotropic ? 6 : 1); ++side) {
        const double cosine = splats[i].normal[side / 2] * (side % 2 == 0 ? 1.0 : -1.0);
        const double share = !anisotropic ? 1.0 : std::max(0.0, cosine);
        for (int c = 0; c < 4; ++c)
          truth[side][c] += share * splats[i].area / volume * (c < 3 ? double{light[i].s[c]} : 1.0);
      }
    double of_voxel = 1.0;
    for (const std::vector<cl_float4>& level : levels_of(pyramid)) {
      CAPTURE(anisotropic, level.size());
      double sum[6][4] = {};
      for (std::size_t k = 0; k < level.size(); ++k)
        for (int c = 0; c < 4; ++c)
          sum[k % pyramid.texels()][c] += of_voxel * level[k].s[c];
      for (unsigned side = 0; side < pyramid.texels(); ++side)
        for (int c = 0; c < 4; ++c) // floats of 400 splats, each in up to some hundred voxels
          CHECK(sum[side][c] == Approx(truth[side][c]).epsilon(1e-4));
      of_voxel *= 8.0;
    }
  }
}

TEST_CASE("light is injected anew each time, and gives the same bits again") {
  const std::vector<Splat> splats = inside_sphere(3000);
  const std::vector<cl_float4> light = varied_light(splats.size());
  VoxelPyramid pyramid(session(), splats, {32, true}), other(session(), splats, {32, true});
  const auto bits = [](const VoxelPyramid& of) {
    std::vector<float> values;
    for (const cl_float4& texel : session().download(of.voxels(), of.voxels().size))
      values.insert(values.end(), texel.s, texel.s + 4);
    return values;
  };
  pyramid.inject(std::vector<cl_float4>(splats.size(), cl_float4{{5.0f, 6.0f, 7.0f, 0.0f}}));
  pyramid.inject(light);
  other.inject(light);
  CHECK(bits(pyramid) == bits(other));
  CHECK_THROWS_AS(pyramid.inject(View<cl_float4>(light.data(), light.size() - 1)), std::invalid_argument);
}
