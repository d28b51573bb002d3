#include "host/photon/emission_plan.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

using namespace pointgi;

namespace {

constexpr double pi = 3.14159265358979;

/// A leaf of one splat that faces upwards: a disc whose sphere it fills.
struct Discs {
  std::vector<Splat> points;
  SpecularLeaves leaves;

  void add(float x, float y, float z, float radius) {
    Splat s{};
    s.position[0] = x, s.position[1] = y, s.position[2] = z;
    s.normal[1] = 1.0f;
    s.radius = radius;
    s.area = static_cast<float>(pi) * radius * radius;
    const auto number = static_cast<std::uint32_t>(points.size());
    points.push_back(s);
    PhotonLeaf leaf{};
    std::copy_n(s.position, 3, leaf.centre);
    leaf.radius = radius;
    leaf.first = number;
    leaf.count = 1;
    leaves.leaf_of.push_back(number);
    leaves.leaves.push_back(leaf);
    leaves.splats.push_back(number);
    leaves.axis.insert(leaves.axis.end(), {0.0f, 1.0f, 0.0f});
    leaves.area.push_back(s.area);
  }
};

LightSource light_source(int type, float x, float y, float z, float strength) {
  LightSource light{};
  light.type = static_cast<decltype(light.type)>(type);
  light.vector[0] = x, light.vector[1] = y, light.vector[2] = z;
  for (float& c : light.strength)
    c = strength;
  return light;
}

/// A lamp that is no specular leaf, of area 0.01 and radiance 5.
void add_lamp(Discs& scene, PhotonSources& sources, float y, float facing) {
  Splat lamp{};
  lamp.position[0] = lamp.position[2] = 0.5f;
  lamp.position[1] = y;
  lamp.normal[1] = facing;
  lamp.area = 0.01f;
  sources.emitters.push_back({static_cast<pg_uint>(scene.points.size()), 1.0f, {}});
  sources.radiance.push_back({5.0f, 5.0f, 5.0f, 0.0f});
  scene.points.push_back(lamp);
  scene.leaves.leaf_of.push_back(NO_PHOTON_LEAF);
}

const auto all_see = [](View<Splat>, View<Segment> segments) { return std::vector<std::uint8_t>(segments.size, 0); };
const auto none_sees = [](View<Splat>, View<Segment> segments) { return std::vector<std::uint8_t>(segments.size, 1); };

EmissionOptions options_of(std::uint64_t photons, bool equal_power = false, std::uint32_t seed = 1) {
  EmissionOptions options;
  options.photons = photons;
  options.equal_power = equal_power;
  options.seed = seed;
  return options;
}

/// The batches follow one another; photons of each source and leaf.
std::map<std::pair<pg_uint, pg_uint>, double> counts_of(const EmissionPlan& plan) {
  std::map<std::pair<pg_uint, pg_uint>, double> counts;
  pg_uint next = 0;
  for (const EmissionBatch& batch : plan.batches) {
    REQUIRE(batch.first == next);
    REQUIRE(batch.count > 0);
    next += batch.count;
    counts[{batch.source, batch.leaf}] += batch.count;
  }
  REQUIRE(next == plan.photons);
  return counts;
}

} // namespace

TEST_CASE("a leaf gets photons by what the light sends into its sphere") {
  Discs scene;
  scene.add(0.5f, 0.1f, 0.5f, 0.02f); // straight below the light
  scene.add(0.8f, 0.1f, 0.5f, 0.05f);
  PhotonSources sources;
  double first = 0.0, second = 0.0;
  SECTION("a point light: the spheres' solid angles") {
    sources.light_sources = {light_source(LIGHT_POINT, 0.5f, 0.6f, 0.5f, 2.0f)};
    const auto solid_angle = [](double r2, double d2) { return 1.0 - std::sqrt(1.0 - r2 / d2); };
    first = solid_angle(0.0004, 0.25), second = solid_angle(0.0025, 0.34);
  }
  SECTION("a directional light: their cross sections") {
    sources.light_sources = {light_source(LIGHT_DIRECTIONAL, 0.6f, 0.8f, 0.0f, 2.0f)};
    first = 0.0004, second = 0.0025;
  }
  SECTION("the environment: their surfaces") {
    sources.environment = {1.0f, 1.0f, 1.0f};
    first = 0.0004, second = 0.0025;
  }
  SECTION("an area light: the solid angles, times the cosine") {
    add_lamp(scene, sources, 0.6f, -1.0f);
    const auto solid_angle = [](double r2, double d2) { return 1.0 - std::sqrt(1.0 - r2 / d2); };
    first = solid_angle(0.0004, 0.25), second = solid_angle(0.0025, 0.34) * 0.5 / std::sqrt(0.34);
  }
  const EmissionPlan plan = plan_emission(scene.leaves, scene.points, sources, all_see, options_of(100'000));
  const auto counts = counts_of(plan);
  REQUIRE(counts.size() == 2);
  // Whole numbers of photons: off by one at most. At least as many as asked for fly, at most four times as many.
  const double all = plan.photons;
  CHECK(all >= 100'000);
  CHECK(all <= 400'001);
  CHECK(counts.begin()->second == Approx(all * first / (first + second)).margin(1.01));
  for (const EmissionBatch& batch : plan.batches) // the photons of a pair have the whole of its light
    CHECK(batch.share * static_cast<float>(batch.count) == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("a leaf that no segment reaches gets an eighth, or nothing where power is equal") {
  Discs scene;
  scene.add(0.3f, 0.1f, 0.5f, 0.03f);
  scene.add(0.7f, 0.1f, 0.5f, 0.03f);
  PhotonSources sources;
  sources.light_sources = {light_source(LIGHT_POINT, 0.5f, 0.6f, 0.5f, 1.0f)};
  const auto left_alone = [](View<Splat> table, View<Segment> segments) {
    std::vector<std::uint8_t> blocked;
    for (const Segment& s : segments)
      blocked.push_back(table[s.to].position[0] > 0.5f ? 1 : 0);
    return blocked;
  };
  auto counts = counts_of(plan_emission(scene.leaves, scene.points, sources, left_alone, options_of(90'000)));
  CHECK(counts[{0, 1}] == Approx(counts[{0, 0}] / 8.0).margin(1.2));
  counts = counts_of(plan_emission(scene.leaves, scene.points, sources, left_alone, options_of(90'000, true)));
  CHECK(counts[{0, 0}] == 90'000);
  CHECK(counts.size() == 1);
  CHECK(plan_emission(scene.leaves, scene.points, sources, none_sees, options_of(1000, true)).photons == 0);
  // Segments miss what lies between them: photons look for it all the same.
  CHECK(plan_emission(scene.leaves, scene.points, sources, none_sees, options_of(1000)).photons >= 1000);
}

TEST_CASE("photons of equal power each carry an equal share of the flux through the discs") {
  Discs scene;
  scene.add(0.5f, 0.1f, 0.5f, 0.02f);
  scene.add(0.8f, 0.1f, 0.5f, 0.05f);
  PhotonSources sources;
  sources.light_sources = {light_source(LIGHT_POINT, 0.5f, 0.6f, 0.5f, 3.0f)};
  const EmissionPlan plan = plan_emission(scene.leaves, scene.points, sources, all_see, options_of(10'000, true));
  CHECK(plan.photons == 10'000);
  const double flux = 3.0 * pi * (0.0004 / 0.25 + 0.0025 * 0.5 / std::sqrt(0.34) / 0.34); // SA = pi r² cos / d²
  for (const EmissionBatch& batch : plan.batches)
    CHECK(batch.share * 10'000.0 == Approx(flux).epsilon(1e-5));
}

TEST_CASE("where less than one photon falls on a leaf, chance makes the mean right") {
  Discs scene;
  for (int i = 0; i < 100; ++i)
    scene.add(0.01f * static_cast<float>(i), 0.1f, 0.5f, 0.004f);
  PhotonSources sources;
  sources.light_sources = {light_source(LIGHT_DIRECTIONAL, 0.0f, 1.0f, 0.0f, 1.0f)};
  std::vector<double> sums(100);
  constexpr int seeds = 400;
  for (std::uint32_t seed = 0; seed < seeds; ++seed)
    for (const EmissionBatch& batch :
         plan_emission(scene.leaves, scene.points, sources, all_see, options_of(25, false, seed)).batches)
      sums[batch.leaf] += static_cast<double>(batch.share) * batch.count;
  // Each leaf's light is sent once on the mean over seeds: one photon in four plans at the least, so that 400 of them
  // are off by sqrt(3 / 400) = 9 %; of 100 leaves, four times that.
  double all = 0.0;
  for (const double sum : sums) {
    CHECK(sum / seeds == Approx(1.0).margin(0.36));
    all += sum / seeds;
  }
  CHECK(all == Approx(100.0).epsilon(0.01)); // every plan has as many photons: only whole numbers are rounded
}

TEST_CASE("no photons from no light, to no leaf, or where none are wanted; a lamp's back sends few") {
  Discs scene;
  scene.add(0.5f, 0.1f, 0.5f, 0.05f);
  PhotonSources sources;
  const auto photons = [&](std::uint64_t wanted) {
    return plan_emission(scene.leaves, scene.points, sources, all_see, options_of(wanted)).photons;
  };
  CHECK(photons(1000) == 0);
  sources.light_sources = {light_source(LIGHT_POINT, 0.5f, 0.6f, 0.5f, 0.0f)};
  CHECK(photons(1000) == 0); // black
  sources.light_sources[0].strength[1] = 1.0f;
  CHECK(photons(0) == 0);
  CHECK(photons(1000) >= 1000);
  CHECK(plan_emission({}, scene.points, sources, all_see, options_of(1000)).photons == 0);

  // A lamp that faces the other way beside one that does not: all emitters are one source, but the leaf is below their
  // horizon as far as these samples tell, and gets a twentieth.
  Discs two;
  two.add(0.5f, 0.1f, 0.5f, 0.01f);
  two.add(0.5f, 0.9f, 0.5f, 0.01f);
  PhotonSources lamp;
  add_lamp(two, lamp, 0.5f, -1.0f);
  auto counts = counts_of(plan_emission(two.leaves, two.points, lamp, all_see, options_of(100'000)));
  CHECK(counts[{SOURCE_EMITTERS, 1}] == Approx(0.05 * counts[{SOURCE_EMITTERS, 0}]).epsilon(0.001));
}

TEST_CASE("as many photons as may be asked for have numbers") {
  Discs scene;
  scene.add(0.5f, 0.1f, 0.5f, 0.05f);
  scene.leaves.area[0] *= 0.01f; // most fly past: four times as many set out
  PhotonSources sources;
  sources.light_sources = {light_source(LIGHT_POINT, 0.5f, 0.6f, 0.5f, 1.0f)};
  const EmissionPlan plan = plan_emission(scene.leaves, scene.points, sources, all_see, options_of(100'000'000));
  REQUIRE(plan.batches.size() == 1);
  CHECK(plan.photons == 400'000'000);
  CHECK(plan.batches[0].count == plan.photons);
}
