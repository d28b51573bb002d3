/// Progressive refinement on the device: all senders as the direct solver, fewer of them as their mean.
#include "host/error.h"
#include "host/passes/build_pools.h"
#include "host/radiosity/gather.h"
#include "host/tune/variant_list.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Room {
  TraversalVariant variant = plain_variant(TraversalForm::wide);
  ClusterTree tree;
  OctreePools packed;
  DevicePools pools;
  std::vector<double> radiosity;

  explicit Room(const std::vector<Splat>& splats)
      : tree(build_clusters(splats, {})), packed(build_pools(splats, variant)),
        pools(upload_pools(session(), packed, variant.storage)), radiosity(varied_radiosity(tree.points)) {}

  std::vector<double> exact() const {
    DeviceDirect direct(session(), pools, variant, tree.points, {});
    std::vector<double> h;
    direct.apply(radiosity, LinearisationPoint::current, h);
    return h;
  }
  DeviceGather make(const GatherOptions& options) const { return {session(), pools, variant, tree, options}; }
};

GatherOptions with(GatherSampling sampling, unsigned window, bool cache = false) {
  GatherOptions options;
  options.sampling = sampling;
  options.window = window;
  options.reciprocity = false;
  options.visibility_cache = cache;
  return options;
}

} // namespace

TEST_CASE("gather from all: reciprocity and cache change rays and bytes, and nothing else", "[long]") {
  const Room room(room_splats(2700)); // several blocks of sums, of which the last is not full
  const auto exact = room.exact();
  DeviceDirect direct(session(), room.pools, room.variant, room.tree.points, {});
  const std::uint64_t pairs = direct.rays(), squares = (room.tree.points.size() + 255) / 256;
  for (const bool reciprocity : {true, false})
    for (const bool cache : {true, false}) {
      GatherOptions options;
      options.reciprocity = reciprocity;
      options.visibility_cache = cache;
      DeviceGather all(session(), room.pools, room.variant, room.tree, options);
      CAPTURE(reciprocity, cache);
      std::vector<double> h, again;
      all.gather(room.radiosity, 0, h);
      all.gather(room.radiosity, 1, again);
      CHECK(h == again);
      CHECK(h == exact);
      CHECK(all.rays() == pairs * (reciprocity ? 1 : 2) * (cache ? 1 : 2));
      CHECK(all.cache_bytes() == (cache ? 8192 * squares * (squares + 1) / 2 : 0)); // a bit an unordered pair
      CHECK(direct_bytes(room.tree.points.size()) == 8192 * squares * (squares + 1) / 2);
      CHECK(all.senders() == room.tree.points.size());
    }
}

TEST_CASE("gather by Monte Carlo is unbiased: the mean of its passes is what all senders give", "[long]") {
  const Room room(room_splats(500));
  const auto exact = room.exact();
  DeviceGather random = room.make(with(GatherSampling::monte_carlo, 16));
  CHECK(random.senders() < room.tree.points.size() / 3);
  constexpr int passes = 300;
  std::vector<double> sum(exact.size()), squares(exact.size()), h, again;
  for (unsigned pass = 0; pass < passes; ++pass) {
    random.gather(room.radiosity, pass, h);
    for (std::size_t i = 0; i < h.size(); ++i) {
      sum[i] += h[i];
      squares[i] += h[i] * h[i];
    }
  }
  random.gather(room.radiosity, passes - 1, again);
  CHECK(h == again); // a pass has its own numbers
  double chi = 0.0, mean_z = 0.0;
  int points = 0;
  for (std::size_t i = 0; i < exact.size(); i += 3) {
    const double mean = sum[i] / passes, variance = (squares[i] / passes - mean * mean) / (passes - 1);
    if (!(variance > 0.0)) continue;
    const double z = (mean - exact[i]) / std::sqrt(variance);
    chi += z * z;
    mean_z += z;
    ++points;
  }
  REQUIRE(points > 400);
  // z of the mean of 300 is normal: its square has the mean 1 and, over 450 points that share no numbers, a scatter of
  // sqrt(2 / 450) = 0.07; five of these. The mean of z: 1 / sqrt(450) = 0.047; four.
  CHECK(chi / points == Approx(1.0).margin(0.35));
  CHECK(std::fabs(mean_z / points) < 0.19);
}

TEST_CASE("gather from windows: the fixed sender and the mean come near all, nearer with smaller windows", "[long]") {
  const Room room(room_splats(3000));
  const auto exact = room.exact();
  for (const GatherSampling sampling : {GatherSampling::fixed, GatherSampling::mipmap}) {
    double before = 0.0;
    for (const unsigned window : {1u, 4u, 16u, 64u}) {
      DeviceGather gather = room.make(with(sampling, window, true));
      std::vector<double> h, again;
      gather.gather(room.radiosity, 0, h);
      gather.gather(room.radiosity, 1, again);
      const double error = relative_l2(h, exact);
      CAPTURE(static_cast<int>(sampling), window, error);
      CHECK(h == again);
      CHECK(gather.cache_bytes() == (room.tree.points.size() + 7) / 8 * gather.senders());
      CHECK(gather_cache_bytes(sampling, room.tree.points.size(), gather.senders()) == gather.cache_bytes());
      if (window == 1) CHECK(error < 1e-4); // every point is its own window
      CHECK(error >= before);
      CHECK(error < 0.25);
      before = error;
    }
  }
}

TEST_CASE("gather in pieces of memory: the same bits as in one, kept or not") {
  const Room room(room_splats(700));
  for (const GatherSampling sampling :
       {GatherSampling::all, GatherSampling::fixed, GatherSampling::mipmap, GatherSampling::monte_carlo})
    for (const bool cache : {false, true}) {
      if (cache && sampling == GatherSampling::monte_carlo) continue;
      GatherOptions options = with(sampling, 8, cache);
      std::vector<double> whole, pieces;
      room.make(options).gather(room.radiosity, 1, whole);
      options.allocation_bytes = 1; // a row each
      DeviceGather gather = room.make(options);
      gather.gather(room.radiosity, 1, pieces);
      CAPTURE(static_cast<int>(sampling), cache);
      CHECK(pieces == whole);
      CHECK((gather.cache_bytes() > 0) == cache);
    }
}

TEST_CASE(
    "gather adaptively: the cut is refined pass by pass to so many senders, and ends nearer to all than it began") {
  const Room room(room_splats(3000));
  const auto exact = room.exact();
  DeviceGather gather = room.make(with(GatherSampling::adaptive, 8));
  std::vector<double> h;
  double first = 0.0, last = 0.0;
  std::size_t senders = 0;
  for (unsigned pass = 0; pass < 12; ++pass) {
    gather.gather(room.radiosity, pass, h);
    last = relative_l2(h, exact);
    if (pass == 0) first = last;
    CHECK(gather.senders() >= senders);
    senders = gather.senders();
  }
  CHECK(gather.is_refined());
  CAPTURE(first, last, senders);
  CHECK(last < 0.7 * first);
}

TEST_CASE("gather with voxels: an empty room is open, a wall blocks, and what is smaller than a voxel is missed",
          "[long]") {
  const auto irradiance = [](const std::vector<Splat>& splats, unsigned voxels, const auto& of) {
    const Room room(splats);
    const Occupancy occupancy = voxels > 0 ? upload_occupancy(session(), points_of(room.packed), voxels) : Occupancy();
    DirectOptions options;
    if (voxels > 0) options.occupancy = &occupancy;
    DeviceDirect direct(session(), room.pools, room.variant, room.tree.points, options);
    std::vector<double> b, h;
    for (const Splat& s : room.tree.points)
      b.insert(b.end(), 3, of(s) ? 1.0 : 0.0);
    direct.apply(b, LinearisationPoint::current, h);
    double sum = 0.0;
    std::size_t points = 0;
    for (std::size_t i = 0; i < room.tree.points.size(); ++i)
      if (room.tree.points[i].normal[2] < -0.9f && room.tree.points[i].position[2] > 0.55f) sum += h[3 * i], ++points;
    return sum / static_cast<double>(points);
  };
  const auto floor = [](const Splat& s) { return s.normal[2] > 0.9f && s.position[2] < 0.45f; };
  const auto empty = inside_cube(18);
  const double by_rays = irradiance(empty, 0, floor);
  CHECK(by_rays == Approx(0.2).epsilon(0.01));
  // Along the edges ends may lie in other walls' voxels, as the grid falls: up to rows of 1.5 voxels, of 25.6 at 32 a
  // side, are lost.
  for (const unsigned voxels : {32u, 64u, 128u}) {
    const double share = 1.0 - 3.0 / (0.8 * voxels), found = irradiance(empty, voxels, floor) / by_rays;
    CAPTURE(voxels, found);
    CHECK(found > 0.98 * share * share);
    CHECK(found < 1.001);
  }
  auto divided = empty;
  for (const double up : {1.0, -1.0}) // both sides of a wall
    add_quad(divided, 18, {0.1, 0.1, 0.5}, {0.8, 0.0, 0.0}, {0.0, 0.8, 0.0}, {0.0, 0.0, up}, 0.64);
  for (Splat& s : divided)
    s.radius *= 1.1f; // or segments between points of lattices meet the corners of the wall's squares, and pass
  for (const unsigned voxels : {0u, 32u, 64u, 128u}) {
    CAPTURE(voxels);
    CHECK(irradiance(divided, voxels, floor) < 1e-3);
  }
  auto speck = empty; // a hundredth of the floor; half a voxel of the coarse grid
  add_quad(speck, 4, {0.496, 0.496, 0.5}, {0.008, 0.0, 0.0}, {0.0, 0.008, 0.0}, {0.0, 0.0, 1.0}, 6.4e-5);
  const double fine = irradiance(speck, 0, floor), coarse = irradiance(speck, 32, floor);
  CHECK(coarse < fine); // it blocks as a whole voxel does
}

TEST_CASE("gather: options that do not go together, and a cache that does not fit, are refused") {
  const Room room(room_splats(600));
  GatherOptions options = with(GatherSampling::monte_carlo, 16, true);
  CHECK_THROWS_AS(room.make(options), std::invalid_argument);
  options = with(GatherSampling::mipmap, 16);
  options.reciprocity = true;
  CHECK_THROWS_AS(room.make(options), std::invalid_argument);
  options = with(GatherSampling::fixed, 4, true);
  options.memory_bytes = 1000;
  try {
    room.make(options);
    FAIL("it took less than a bit a pair");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::memory);
    CHECK_THAT(error.what(), Catch::Contains("visibility_cache = false"));
  }
}
