#include "host/photon/photon_map.h"
#include "tests/support/photons.h"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>

using namespace pointgi;
using namespace pointgi::test;

namespace {

using Values = std::vector<float>;

/// A photon as its bucket has it.
Values in_bucket(const PhotonMap& map, std::size_t photon) {
  Values values;
  for (std::size_t word = 0; word < PHOTON_WORDS; ++word)
    values.push_back(
        map.buckets[photon / PHOTON_LANES * PHOTON_BUCKET_WORDS + word * PHOTON_LANES + photon % PHOTON_LANES]);
  return values;
}

Values as_values(const Photon& p) {
  Values values(p.position, p.position + 3);
  values.push_back(0.0f);
  std::memcpy(&values[3], &p.inward, sizeof p.inward);
  values.insert(values.end(), p.power, p.power + 3);
  return values;
}

bool inside(const PhotonNode& node, unsigned child, const Values& photon) {
  for (int a = 0; a < 3; ++a)
    if (photon[a] < node.low[a][child] || photon[a] > node.high[a][child]) return false;
  return true;
}

/// Whether every box from the root down to the photon's bucket holds it.
bool found_from_root(const PhotonMap& map, std::size_t photon) {
  const Values values = in_bucket(map, photon);
  const std::size_t bucket = photon / PHOTON_LANES;
  std::size_t node = 0;
  for (unsigned level = 0; level < map.levels; ++level) {
    const auto child = static_cast<unsigned>(bucket >> (3 * (map.levels - 1 - level)) & 7);
    if (node >= map.nodes.size() || !inside(map.nodes[node], child, values)) return false;
    node = 8 * node + 1 + child;
  }
  return true;
}

} // namespace

TEST_CASE("the photon map holds each photon once, where the walk from its root looks for it") {
  // Around whole buckets and whole levels, where the numbering is at its borders.
  for (const std::size_t count : {1u, 15u, 16u, 17u, 128u, 129u, 1024u, 1025u, 5000u}) {
    CAPTURE(count);
    auto photons = caustic_photons(count, 3);
    for (std::size_t i = 0; i < count; ++i)
      photons[i].power[1] = static_cast<float>(i); // none like another
    const PhotonMap map = build_photon_map(photons);
    REQUIRE(map.photons == count);
    REQUIRE(map.bucket_count() == (count + PHOTON_LANES - 1) / PHOTON_LANES);
    std::vector<Values> given, kept;
    for (std::size_t i = 0; i < count; ++i) {
      given.push_back(as_values(photons[i]));
      kept.push_back(in_bucket(map, i));
      REQUIRE(found_from_root(map, i));
    }
    std::sort(given.begin(), given.end());
    std::sort(kept.begin(), kept.end());
    CHECK(given == kept);
    for (std::size_t i = count; i < map.bucket_count() * PHOTON_LANES; ++i)
      CHECK(in_bucket(map, i)[0] == PHOTON_NOWHERE);
  }
}

TEST_CASE("a photon map of none, of one place, of what is not finite") {
  CHECK(build_photon_map(std::vector<Photon>{}).levels == 0);
  const float down[3] = {0.0f, 0.0f, -1.0f};
  const PhotonMap one_place = build_photon_map(std::vector<Photon>(100'000, make_photon(0.5f, 0.5f, 0.5f, down)));
  CHECK(one_place.bucket_count() == 6250);
  auto photons = caustic_photons(100, 1);
  photons[40].position[1] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(build_photon_map(photons), std::invalid_argument);
}

TEST_CASE("packed directions come back to within their rounding") {
  std::mt19937 g(5);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 1000; ++i) {
    float d[3] = {gauss(g), gauss(g), gauss(g)}, back[3];
    const float length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (float& c : d)
      c /= length;
    unpack_direction(packed_direction(d), back);
    for (int a = 0; a < 3; ++a)
      REQUIRE(back[a] == Approx(d[a]).margin(0.5001 / 511));
  }
  const float axis[3] = {-1.0f, 0.0f, 1.0f};
  float back[3];
  unpack_direction(packed_direction(axis), back);
  CHECK(std::equal(axis, axis + 3, back));
}
