#include "host/photon/kept_photons.h"
#include <catch2/catch.hpp>

using namespace pointgi;

namespace {

/// Photon i of these has power i + 1.
std::vector<Photon> kept(std::uint32_t count, std::size_t most, std::uint32_t seed, std::uint64_t* one_of = nullptr) {
  KeptPhotons photons(most, seed);
  for (std::uint32_t i = 0; i < count; ++i) {
    Photon photon{};
    photon.splat = i;
    photon.power[0] = photon.power[1] = photon.power[2] = static_cast<float>(i + 1);
    photons.add(photon, i);
  }
  if (one_of != nullptr) *one_of = photons.one_of();
  return photons.take();
}

} // namespace

TEST_CASE("as many photons as there is room for are all kept") {
  std::uint64_t one_of = 0;
  const auto all = kept(1000, 1000, 1, &one_of);
  CHECK(one_of == 1);
  REQUIRE(all.size() == 1000);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    REQUIRE(all[i].splat == i);
    REQUIRE(all[i].power[2] == static_cast<float>(i + 1));
  }
}

TEST_CASE("of too many photons some are kept in order, with the power of all") {
  for (const std::size_t most : {1u, 999u, 400u, 30u}) {
    std::uint64_t one_of = 0;
    const auto some = kept(1000, most, 1, &one_of);
    CAPTURE(most, one_of, some.size());
    CHECK(some.size() <= most);
    if (most > 1) CHECK_FALSE(some.empty());
    CHECK(one_of >= 2);
    for (std::size_t k = 0; k < some.size(); ++k) {
      REQUIRE((k == 0 || some[k].splat > some[k - 1].splat));
      REQUIRE(some[k].power[1] == static_cast<float>(some[k].splat + 1) * static_cast<float>(one_of));
    }
  }
  // A photon stays with a chance of 1 in one_of. Over seeds: the mean of 200 sums, each off by some
  // sqrt(one_of - 1) / sqrt(1000) of itself, 12 % with one_of = 16; of their mean three times 0.8 %.
  double sum = 0.0;
  for (std::uint32_t seed = 0; seed < 200; ++seed)
    for (const Photon& photon : kept(1000, 100, seed))
      sum += double{photon.power[0]};
  CHECK(sum / 200.0 == Approx(500500.0).epsilon(0.025));
}
