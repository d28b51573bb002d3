/// One cone through voxels whose light is known: slabs, single voxels, planes of splats.
#include "host/passes/variant.h"
#include "host/radiosity/voxel_pyramid.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pointgi;
using namespace pointgi::test;
using Eigen::Vector3d;

namespace {

/// Opacity of a slab, by the surface across it; CONE_COVER of kernels/lib/cone.cl.
double opacity_of(double surface) {
  return std::min(1.0, 1.3 * surface);
}

struct GivenCone {
  Vector3d apex; ///< voxels from the grid's corner
  Vector3d direction;
  double spread = 0.0;
};

std::vector<cl_float4> seen_by(const std::vector<GivenCone>& cones, const ConeGrid& grid,
                               const Buffer<cl_float4>& voxels, const Buffer<cl_uchar>& cells, unsigned texels) {
  std::vector<float> numbers;
  for (const GivenCone& c : cones) {
    const Vector3d d = c.direction.normalized();
    for (const double value : {c.apex[0], c.apex[1], c.apex[2], c.spread, d[0], d[1], d[2], 0.0})
      numbers.push_back(static_cast<float>(value));
  }
  const Program program = cones_program("test/cone_probe.cl", texels);
  cl::Kernel kernel = session().kernel(program.file, program.options, "trace_given_cones");
  const auto seen = session().allocate<cl_float4>(cones.size());
  session().launch(kernel, LaunchShape::line(cones.size()), session().upload(numbers),
                   static_cast<cl_uint>(cones.size()), session().upload(&grid, 1), voxels, cells, seen);
  return session().download(seen, cones.size());
}

/// 32^3 voxels filled by hand, and their means upwards.
struct HandMade {
  static constexpr pg_uint side = 32;
  unsigned texels;
  ConeGrid grid{};
  std::vector<cl_float4> voxels;

  explicit HandMade(unsigned texels_of_voxel) : texels(texels_of_voxel) {
    grid.voxel = 1.0f / side;
    grid.side_log2 = 5;
    pg_uint first = 0;
    for (pg_uint level = 0; level < CONE_GRID_LEVELS(&grid); ++level) {
      grid.first[level] = first;
      const pg_uint row = (side >> level) + 2u;
      first += row * row * row;
    }
    voxels.resize(std::size_t{first} * texels);
  }
  /// Adds a texel's value to a voxel and its part to those above.
  void add(pg_uint x, pg_uint y, pg_uint z, unsigned texel, double radiosity, double area) {
    double share = 1.0;
    for (pg_uint level = 0; level < CONE_GRID_LEVELS(&grid); ++level, share /= 8.0) {
      const pg_uint row = (side >> level) + 2u;
      const pg_uint at = grid.first[level] + (((z >> level) + 1u) * row + (y >> level) + 1u) * row + (x >> level) + 1u;
      cl_float4& value = voxels[std::size_t{texels} * at + texel];
      for (int c = 0; c < 4; ++c)
        value.s[c] += static_cast<float>(share * area * (c < 3 ? radiosity * (c + 1) : 1.0));
    }
  }
  /// `thickness` layers across x from 16 on.
  void add_slab(pg_uint thickness, unsigned texel, double radiosity, double area) {
    for (pg_uint x = 16; x < 16 + thickness; ++x)
      for (pg_uint y = 0; y < side; ++y)
        for (pg_uint z = 0; z < side; ++z)
          add(x, y, z, texel, radiosity, area);
  }
  std::vector<cl_float4> seen(const std::vector<GivenCone>& cones) const {
    const std::vector<cl_uchar> all(voxels.size() / texels, 1);
    return seen_by(cones, grid, session().upload(voxels), session().upload(all), texels);
  }
};

} // namespace

TEST_CASE("a slab covers by its surface, and shines with its radiosity times that") {
  for (const double area : {0.02, 0.1, 0.25})
    for (const pg_uint thickness : {1u, 3u}) {
      HandMade slab(CONE_SIDES_ISOTROPIC);
      slab.add_slab(thickness, 0, 2.0, area);
      const double surface = area * thickness;
      CAPTURE(area, thickness);
      std::vector<GivenCone> along, askew;
      for (const double x : {1.0, 1.3, 1.5, 1.9}) { // whatever the offset
        along.push_back({{x, 15.2, 16.7}, {1.0, 0.0, 0.0}});
        askew.push_back({{x, 12.2, 12.7}, {1.0, 0.4, 0.3}});
      }
      for (const cl_float4& seen : slab.seen(along)) {
        // Samples a voxel apart add up to all of a voxel's tent.
        CHECK(seen.s[3] == Approx(opacity_of(surface)).margin(1e-4));
        for (int c = 0; c < 3; ++c)
          CHECK(seen.s[c] == Approx(2.0 * (c + 1) * seen.s[3]).epsilon(1e-5));
      }
      // Askew they lie 0.89 voxels apart across the slab: a sum over the tent of one layer is up to 4 % off.
      for (const cl_float4& seen : slab.seen(askew))
        CHECK(seen.s[3] == Approx(opacity_of(surface * std::sqrt(1.25))).epsilon(0.04));
    }
}

TEST_CASE("a wide cone finds the same slab in coarse voxels") {
  HandMade slab(CONE_SIDES_ISOTROPIC);
  slab.add_slab(1, 0, 1.0, 0.1);
  // Samples 4 to 14 voxels wide, each wider than the one before: their tents do not add up to one.
  // most.
  for (const double spread : {0.25, 0.5, 1.0})
    for (const cl_float4& seen :
         slab.seen({{{1.0, 15.0, 15.0}, {1.0, 0.0, 0.0}, spread}, {{3.5, 17.0, 15.0}, {1.0, 0.0, 0.0}, spread}})) {
      CAPTURE(spread);
      CHECK(seen.s[3] == Approx(opacity_of(0.1)).epsilon(0.4));
      CHECK(seen.s[0] == Approx(seen.s[3]).epsilon(1e-5));
    }
}

TEST_CASE("a single voxel shines by how near a ray comes to its middle") {
  HandMade one(CONE_SIDES_ISOTROPIC);
  one.add(20, 16, 16, 0, 3.0, 0.25);
  std::vector<GivenCone> cones;
  std::vector<double> surface;
  for (const double y : {-1.0, -0.5, 0.0, 0.25, 0.75})
    for (const double z : {0.0, 0.3, 1.2}) {
      cones.push_back({{2.4, 16.5 + y, 16.5 + z}, {1.0, 0.0, 0.0}});
      surface.push_back(0.25 * std::max(0.0, 1.0 - std::fabs(y)) * std::max(0.0, 1.0 - std::fabs(z)));
    }
  const std::vector<cl_float4> seen = one.seen(cones);
  for (std::size_t k = 0; k < cones.size(); ++k) {
    CAPTURE(k);
    CHECK(seen[k].s[3] == Approx(opacity_of(surface[k])).margin(1e-5));
    CHECK(seen[k].s[0] == Approx(3.0 * opacity_of(surface[k])).margin(3e-5));
  }
}

TEST_CASE("six texels: a wall shines to its front at every angle, its back is black and as opaque") {
  HandMade wall(CONE_SIDES_ANISOTROPIC);
  wall.add_slab(1, 1, 2.0, 0.3);           // faces -x
  for (const double y : {0.0, 0.5, 1.0}) { // 45 degrees: samples 0.7 voxels apart across the wall
    CAPTURE(y);
    const auto seen = wall.seen({{{4.0, 10.0, 16.0}, {1.0, y, 0.0}}, {{28.0, 10.0, 16.0}, {-1.0, y, 0.0}}});
    for (const cl_float4& side : seen)
      CHECK(side.s[3] == Approx(opacity_of(0.3)).epsilon(y == 0.0 ? 1e-4 : 0.06));
    CHECK(seen[0].s[0] == Approx(2.0 * seen[0].s[3]).epsilon(1e-5));
    CHECK(seen[1].s[0] == 0.0f);
  }
  // Two sheets back to back in one voxel, as a thin wall has: each side hides the other.
  wall.add_slab(1, 0, 7.0, 0.3);
  const auto both = wall.seen({{{4.0, 10.0, 16.0}, {1.0, 0.0, 0.0}}, {{28.0, 10.0, 16.0}, {-1.0, 0.0, 0.0}}});
  CHECK(both[0].s[0] == Approx(2.0 * opacity_of(0.3)).epsilon(1e-4));
  CHECK(both[1].s[0] == Approx(7.0 * opacity_of(0.3)).epsilon(1e-4));
}

TEST_CASE("a plane of splats is closed, whatever its offset and angle") {
  std::mt19937 g(12);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 12; ++k) {
    const Vector3d n = k == 0 ? Vector3d(0, 0, 1) : Vector3d(unit(g), unit(g), unit(g)).normalized();
    const Vector3d u = n.unitOrthogonal(), v = n.cross(u), middle = Vector3d(0.5, 0.5, 0.5) + 0.05 * unit(g) * n;
    std::vector<Splat> splats;
    for (int i = -20; i <= 20; ++i)
      for (int j = -20; j <= 20; ++j) {
        const Vector3d p = middle + 0.015 * (i * u + j * v);
        splats.push_back(area_splat(p[0], p[1], p[2], n[0], n[1], n[2], 0.015 * 0.015));
      }
    for (const bool anisotropic : {false, true}) {
      CAPTURE(k, anisotropic);
      VoxelPyramid pyramid(session(), splats, {64, anisotropic});
      pyramid.inject(std::vector<cl_float4>(splats.size(), cl_float4{{1.0f, 1.0f, 1.0f, 0.0f}}));
      const ConeGrid& grid = pyramid.grid();
      std::vector<GivenCone> cones;
      for (int m = 0; m < 40; ++m) { // down onto the plane's inner part, up to 45 degrees from its normal
        const Vector3d towards = -n + 0.7 * (unit(g) * u + unit(g) * v);
        const Vector3d from = middle + 0.15 * (unit(g) * u + unit(g) * v) - 0.1 * towards;
        cones.push_back({(from - Eigen::Vector3f(grid.origin).cast<double>()) / grid.voxel, towards});
      }
      double opacity = 0.0;
      for (const cl_float4& seen : seen_by(cones, grid, pyramid.voxels(), pyramid.cells(), pyramid.texels())) {
        // Voxels share a slanting plane unevenly, and samples lie a voxel apart: some rays without a width find less
        // than 1 of a surface, though 1.3 is the mean.
        CHECK(seen.s[3] > 0.7f);
        CHECK(seen.s[0] <= 1.0001f);
        CHECK(seen.s[0] > (0.7f));
        opacity += double{seen.s[3]} / static_cast<double>(cones.size());
      }
      CHECK(opacity > 0.96);
    }
  }
}
