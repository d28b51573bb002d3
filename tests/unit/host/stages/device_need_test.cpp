/// Memory of stages by closed forms, and passes that are foretold.
#include "host/photon/photon_map.h"
#include "host/radiosity/direct.h"
#include "host/radiosity/directions.h"
#include "host/stages/device_need.h"
#include "host/stages/exchange_sample.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

constexpr std::uint64_t much = std::uint64_t{1} << 40;

} // namespace

TEST_CASE("hits of directions take four bytes a ray where there is room, and what there is where there is not") {
  RadiositySettings settings;
  settings.directions = 512;
  const ExchangedCount count{10000, 12000};
  const DeviceNeed need = exchange_need("directions", settings, count, much);
  const std::uint64_t hits = 4u * 512u * 10000u;
  CHECK(need.usual > hits);
  CHECK(need.usual < hits + hits / 10);
  CHECK(need.least < hits / 10);
  const DeviceNeed tight = exchange_need("directions", settings, count, hits / 2);
  CHECK(tight.usual < hits / 2);
  CHECK(tight.least == need.least);
}

TEST_CASE("hits leave the room that the points of a large cloud take besides") {
  const std::uint64_t left = 11'000'000'000; // half of what a machine of 24 GiB has
  CHECK(bytes_for_hits(left, 3'000'000) > std::uint64_t{4} * 512 * 3'000'000);
  CHECK(bytes_for_hits(left, 10'000'000) < bytes_for_hits(left, 3'000'000) - 2'000'000'000);
  CHECK(bytes_for_hits(left, 30'000'000) == 24u * 30'000'000u);
  CHECK(bytes_for_hits(100'000'000, 1'000'000) <= 75'000'000 - 32'000'000); // of a device that has no more
  CHECK(bytes_for_hits(1000, 1'000'000) == 0);
}

TEST_CASE("pairs take a bit each where they are kept, and gather can do without") {
  RadiositySettings settings;
  const ExchangedCount count{20000, 20000};
  CHECK(exchange_need("direct", settings, count, much).least >= direct_bytes(20000));
  CHECK(exchange_need("direct", settings, count, much).least < direct_bytes(20000) + 20000 * 200);
  settings.method = "gather";
  CHECK(exchange_need("gather", settings, count, much).least == exchange_need("direct", settings, count, much).least);
  settings.visibility_cache = false;
  CHECK(exchange_need("gather", settings, count, much).least < direct_bytes(20000) / 2);
  settings.visibility_cache.reset();
  settings.sampling = "mipmap";
  CHECK(exchange_need("gather", settings, count, much).least < direct_bytes(20000) / 2);
}

TEST_CASE("cones take a voxel's texels, so that half the side is an eighth") {
  RadiositySettings settings;
  settings.voxels = 256;
  const ExchangedCount count{1, 1};
  const auto bytes = static_cast<double>(exchange_need("cones", settings, count, much).least);
  CHECK(bytes > 256.0 * 256.0 * 256.0 * 6 * 16);
  CHECK(bytes < 256.0 * 256.0 * 256.0 * 6 * 16 * 1.3);
  settings.voxels = 128;
  CHECK(static_cast<double>(exchange_need("cones", settings, count, much).least) == Approx(bytes / 8).epsilon(0.1));
  settings.anisotropic = false;
  CHECK(static_cast<double>(exchange_need("cones", settings, count, much).least) < bytes / 40);
}

TEST_CASE("nothing that exchanges light needs nothing") {
  for (const char* method : {"directions", "direct", "gather", "cones"})
    CHECK(exchange_need(method, {}, {0, 100}, much).usual == 0);
  CHECK(fmm_bytes({}, 3, {}) == 0);
}

TEST_CASE("a photon map's bytes are those that it is told to have") {
  for (const std::size_t photons : {1u, 100u, 5000u, 70000u}) {
    std::vector<Photon> all(photons);
    for (std::size_t i = 0; i < photons; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        all[i].position[a] = static_cast<float>((i * (7 + 4 * a)) % 1009) / 1009.0f;
    const PhotonMap map = build_photon_map(all);
    const double bytes =
        static_cast<double>(map.nodes.size() * sizeof(PhotonNode) + map.buckets.size() * sizeof(float));
    CAPTURE(photons);
    CHECK(static_cast<double>(photon_map_bytes(photons, 0)) > 0.5 * bytes);
    CHECK(static_cast<double>(photon_map_bytes(photons, 0)) < 2.0 * bytes);
  }
}

TEST_CASE("passes end where all later ones add less than the tolerance, as the last ones fade") {
  CHECK(passes_until({}, 1e-3) == 1);
  CHECK(passes_until({0.0}, 1e-3) == 1);
  // Halves: after pass k, 2^-k is left and as much follows.
  CHECK(passes_until({0.5, 0.25}, 1.01 / 1024.0) == 10);
  CHECK(passes_until({0.5, 0.25, 0.125, 0.0625}, 0.3) == 2);
  CHECK(passes_until({1.0, 1.0}, 1e-3) == 10000);
}
