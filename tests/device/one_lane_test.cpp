/// Sums over pairs by work-items of one lane, as GPUs have them, against work-items of a whole block, as CPU devices
/// do.
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

/// Roundings alone: the terms and their order are the same.
constexpr double rounding = 1e-6;

struct Room {
  TraversalVariant variant = plain_variant(TraversalForm::wide);
  ClusterTree tree = build_clusters(room_splats(1101), {}); // the last block is not full
  OctreePools packed = build_pools(tree.points, variant);
  std::vector<double> radiosity = varied_radiosity(tree.points);

  DevicePools pools(Session& on) const { return upload_pools(on, packed, variant.storage); }
};

} // namespace

TEST_CASE("direct: one lane a work-item gives what blocks give") {
  const Room room;
  REQUIRE(room.tree.points.size() % FMM_LANES != 0);
  const auto irradiance = [&](Session& on) {
    std::vector<double> h;
    DeviceDirect(on, room.pools(on), room.variant, room.tree.points, {})
        .apply(room.radiosity, LinearisationPoint::current, h);
    return h;
  };
  const auto blocks = irradiance(session()), lanes = irradiance(gpu_session());
  CHECK(relative_l2(lanes, blocks) < rounding);
}

TEST_CASE("gather: one lane a work-item gives what blocks give, of senders that are shared and of those picked") {
  const Room room;
  for (const GatherSampling sampling : {GatherSampling::fixed, GatherSampling::mipmap, GatherSampling::monte_carlo}) {
    CAPTURE(static_cast<int>(sampling));
    GatherOptions options;
    options.sampling = sampling;
    options.window = 16;
    options.reciprocity = false;
    options.visibility_cache = false;
    const auto irradiance = [&](Session& on) {
      std::vector<double> h;
      DeviceGather(on, room.pools(on), room.variant, room.tree, options).gather(room.radiosity, 3, h);
      return h;
    };
    const auto blocks = irradiance(session()), lanes = irradiance(gpu_session());
    CHECK(relative_l2(lanes, blocks) < rounding);
  }
}
