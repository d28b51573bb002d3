#include "host/passes/device_pools.h"
#include "octree/ref/descend.h"
#include "shared/cone_types.h"
#include "shared/pair_types.h"
#include "shared/photon_types.h"
#include "shared/render_types.h"
#include "shared/traversal_types.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

TEST_CASE("device and host lay the shared structs out alike") {
  Session& device = session();
  const std::vector<std::size_t> host = {
      sizeof(OctreeNode),
      offsetof(OctreeNode, address),
      offsetof(OctreeNode, extra),
      offsetof(OctreeNode, count),
      sizeof(OctreePoint),
      offsetof(OctreePoint, radius),
      offsetof(OctreePoint, normal),
      offsetof(OctreePoint, material),
      offsetof(OctreePoint, colour),
      offsetof(OctreePoint, area),
      sizeof(Camera),
      sizeof(RenderParams),
      offsetof(RenderParams, environment),
      offsetof(RenderParams, samples),
      offsetof(RenderParams, emitters),
      offsetof(RenderParams, step_delta),
      sizeof(LightSource),
      offsetof(LightSource, strength),
      offsetof(LightSource, cumulative),
      sizeof(Emitter),
      sizeof(Material),
      sizeof(RayQuery),
      sizeof(RayAnswer),
      sizeof(RayPacketQuery),
      offsetof(RayPacketQuery, t_max),
      sizeof(RayPacketAnswer),
      sizeof(EyeHits),
      sizeof(SegmentQuery),
      offsetof(Material, type),
      offsetof(Material, specular),
      offsetof(Material, absorption),
      offsetof(Material, ior),
      sizeof(Photon),
      offsetof(Photon, power),
      sizeof(PhotonNode),
      offsetof(PhotonNode, high),
      sizeof(PhotonLeaf),
      offsetof(PhotonLeaf, first),
      sizeof(EmissionBatch),
      offsetof(EmissionBatch, share),
      sizeof(PhotonFlight),
      offsetof(PhotonFlight, end),
      offsetof(PhotonFlight, absorbed),
      sizeof(GatherParams),
      offsetof(GatherParams, radius2),
      sizeof(ConeGrid),
      offsetof(ConeGrid, side_log2),
      offsetof(ConeGrid, first),
      sizeof(Cone),
      offsetof(Cone, spread),
      sizeof(VoxelShare),
      sizeof(PairRows),
      offsetof(PairRows, points),
      offsetof(PairRows, step_delta),
      sizeof(SenderRows),
      offsetof(SenderRows, receivers),
      offsetof(SenderRows, step_delta),
  };
  const auto sizes = device.allocate<cl_uint>(host.size());
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(TraversalVariant{}), "probe_layout");
  device.launch(kernel, LaunchShape{{1, 1}, {1, 1}}, sizes);
  const auto found = device.download(sizes, host.size());
  for (std::size_t i = 0; i < host.size(); ++i) {
    CAPTURE(i);
    CHECK(found[i] == host[i]);
  }
}

TEST_CASE("the device descends as the host does, in every storage and branching") {
  TraversalVariant variant;
  variant.storage = GENERATE(PoolStorage::buffer, PoolStorage::image1d_buffer, PoolStorage::image2d);
  variant.axis_bits = GENERATE(1u, 2u);
  const auto splats = mixed_splats();
  const StepPools pools = pack_step(splats, build_tree(splats, {variant.axis_bits, 4, 21 / variant.axis_bits}));
  std::mt19937 g(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<cl_float4> positions(20'000);
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (int a = 0; a < 3; ++a) // half of them on corners of cells
      positions[i].s[a] = i % 2 == 0 ? std::min(unit(g), 0.99999994f) : std::floor(64.0f * unit(g)) / 64.0f;
  Session& device = session();
  const DevicePools on_device = upload_pools(device, pools, variant.storage);
  const auto in = device.upload(positions);
  const auto out = device.allocate<OctreeNode>(positions.size());
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(variant), "probe_descent");
  device.launch(kernel, LaunchShape::line(positions.size()), on_device.nodes, on_device.leaves, on_device.points, in,
                out, static_cast<cl_uint>(positions.size()));
  const auto found = device.download(out, positions.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const OctreeNode truth = descend(pools, {positions[i].s[0], positions[i].s[1], positions[i].s[2]});
    different += truth.header != found[i].header || truth.address != found[i].address || truth.count != found[i].count;
  }
  CHECK(different == 0);
}

TEST_CASE("random numbers are the published hash's") {
  // pcg4d as printed by Jarzynski and Olano (JCGT 9(3), 2020), computed here independently of the kernel.
  const auto truth = [](std::uint32_t seed) {
    std::uint32_t v[4] = {seed, seed, seed, seed};
    for (std::uint32_t& c : v)
      c = c * 1664525u + 1013904223u;
    const auto mix = [&] {
      v[0] += v[1] * v[3];
      v[1] += v[2] * v[0];
      v[2] += v[0] * v[1];
      v[3] += v[1] * v[2];
    };
    mix();
    for (std::uint32_t& c : v)
      c ^= c >> 16;
    mix();
    return std::vector<std::uint32_t>(v, v + 4);
  };
  Session& device = session();
  const cl_uint count = 256;
  const auto values = device.allocate<cl_uint4>(count);
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(TraversalVariant{}), "probe_rng");
  device.launch(kernel, LaunchShape::line(count), values, count);
  const auto found = device.download(values, count);
  for (cl_uint i = 0; i < count; ++i)
    REQUIRE(std::vector<std::uint32_t>(found[i].s, found[i].s + 4) == truth(i));
}

namespace {

/// Places of all samples of `pixels` pixels, pixel after pixel.
std::vector<cl_float2> places_of(cl_uint pixels, cl_uint samples, cl_uint seed, bool jitter) {
  Session& device = session();
  const auto places = device.allocate<cl_float2>(std::size_t{pixels} * samples);
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(TraversalVariant{}), "probe_places");
  device.launch(kernel, LaunchShape::line(pixels), places, samples, seed, jitter ? 1u : 0u, pixels);
  return device.download(places, std::size_t{pixels} * samples);
}

int stratum(float place, cl_uint strata) {
  return static_cast<int>(place * static_cast<float>(strata));
}

} // namespace

TEST_CASE("cosine and sine of a turn are those of the angle, in lanes as well") {
  std::vector<float> turns{0.0f, 0.125f, 0.25f, 0.375f, 0.5f, 0.625f, 0.75f, 0.875f, 1.0f, 0.99999994f, 5.9604645e-8f};
  std::mt19937 g(5);
  while (turns.size() < 65536)
    turns.push_back(static_cast<float>(g() >> 8) * 0x1p-24f);
  Session& device = session();
  const auto in = device.upload(turns);
  const auto scalars = device.allocate<cl_float2>(turns.size());
  const auto lanes = device.allocate<float>(2 * turns.size());
  cl::Kernel kernel = device.kernel("test/probe.cl", build_options(TraversalVariant{}), "probe_turn");
  device.launch(kernel, LaunchShape::line(turns.size() / 16, 1), in, scalars, lanes);
  const auto found = device.download(scalars, turns.size());
  const auto in_lanes = device.download(lanes, 2 * turns.size());
  double largest = 0.0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double angle = 2.0 * 3.14159265358979323846 * double{turns[i]};
    largest = std::max({largest, std::fabs(double{found[i].s[0]} - std::cos(angle)),
                        std::fabs(double{found[i].s[1]} - std::sin(angle))});
    const std::size_t lane = i / 16 * 32 + i % 16;
    different += found[i].s[0] != in_lanes[lane] || found[i].s[1] != in_lanes[lane + 16];
  }
  CHECK(largest < 2e-7); // two roundings of a float below 1, and that of the angle
  CHECK(different == 0);
}

TEST_CASE("every part of a pixel is sampled alike, whatever the number of samples") {
  const cl_uint pixels = 4096, samples = GENERATE(1u, 3u, 5u, 7u, 12u, 20u, 24u, 25u, 31u, 32u, 48u, 50u);
  constexpr int cells = 12; // a side; no multiple of most numbers of strata, nor they of it
  std::vector<double> found(cells * cells);
  for (const cl_uint seed : {1u, 2u})
    for (const cl_float2& p : places_of(pixels, samples, seed, true)) {
      REQUIRE((p.s[0] >= 0.0f && p.s[0] < 1.0f && p.s[1] >= 0.0f && p.s[1] < 1.0f));
      found[static_cast<std::size_t>(cells * stratum(p.s[1], cells) + stratum(p.s[0], cells))] += 1.0;
    }
  const double expected = 2.0 * pixels * samples / (cells * cells);
  double chi2 = 0.0;
  for (const double n : found)
    chi2 += (n - expected) * (n - expected) / expected;
  CAPTURE(samples);
  const double freedom = cells * cells - 1; // of independent samples; strata make it less
  CHECK(chi2 < freedom + 4.0 * std::sqrt(2.0 * freedom));
}

TEST_CASE("the last samples of a pixel are spread over it, and so are the first of these") {
  const bool jitter = GENERATE(true, false);
  const cl_uint samples = GENERATE(3u, 5u, 6u, 12u, 20u, 24u, 25u, 31u, 35u, 56u, 63u), n = samples % 32u;
  const cl_uint pixels = 64;
  const auto places = places_of(pixels, samples, 7, jitter);
  CAPTURE(samples, jitter);
  for (cl_uint pixel = 0; pixel < pixels; ++pixel)
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<int> of_stratum(n);
      int below = 0;
      for (cl_uint k = 0; k < n; ++k) {
        const float at = places[samples * pixel + samples - n + k].s[axis];
        of_stratum[static_cast<std::size_t>(stratum(at, n))] += 1;
        below += at < 0.5f;
        // A prefix of the sequences leaves one half ahead by two samples at most, their shift round the pixel by two
        // more.
        REQUIRE(std::abs(2 * below - static_cast<int>(k + 1)) <= 4);
      }
      REQUIRE(of_stratum == std::vector<int>(n, 1));
    }
}
