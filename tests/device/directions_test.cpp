/// Directional sampling on the device: what points see, against linear scans and closed forms.
#include "host/lights/sky_model.h"
#include "host/lights/smooth_sky.h"
#include "host/passes/build_pools.h"
#include "host/radiosity/directions.h"
#include "host/tune/variant_list.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include "tests/support/exchange.h"
#include "tests/support/rooms.h"
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace pointgi;
using namespace pointgi::test;

namespace {

std::vector<std::uint32_t> all_places(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

struct Traced {
  TraversalVariant variant;
  OctreePools packed;
  DevicePools pools;
  std::vector<std::uint32_t> places;

  explicit Traced(const std::vector<Splat>& splats, TraversalForm form = TraversalForm::wide)
      : Traced(splats, plain_variant(form)) {}
  Traced(const std::vector<Splat>& splats, const TraversalVariant& of, const SplatClips& clips = {})
      : variant(of), packed(build_pools(splats, variant, clips)),
        pools(upload_pools(session(), packed, variant.storage)), places(all_places(splats.size())) {}

  View<Splat> points() const { return points_of(packed); }
  template <class Radiosity>
  std::vector<double> irradiance(const DirectionsOptions& options, const Radiosity& radiosity) const {
    DeviceDirections exchange(session(), pools, variant, points(), places, options);
    std::vector<double> b, h;
    for (const Splat& s : points())
      b.insert(b.end(), 3, radiosity(s));
    exchange.apply(b, LinearisationPoint::current, h);
    return h;
  }
};

DirectionsOptions with(unsigned directions, DirectionPattern pattern = DirectionPattern::stratified) {
  DirectionsOptions options;
  options.directions = directions;
  options.pattern = pattern;
  return options;
}

std::vector<Splat> widened(std::vector<Splat> splats) {
  for (Splat& s : splats)
    s.radius *= 1.1f;
  return splats;
}

std::size_t differences(const std::vector<double>& a, const std::vector<double>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    count += a[i] != b[i];
  return count;
}

/// Form factor of [0, x] x [0, y] at the distance 1 with the differential area at 0 that faces it.
double corner(double x, double y) {
  const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * 3.14159265358979);
}

} // namespace

TEST_CASE("directions on the device: inside a closed surface all light arrives, point by point") {
  // Stratified samples of a constant have no noise: what is missing are rays that got out or met a back.
  // Discs that leave no pinholes at the corners of their squares: a hemicube's lattice may look through a wall's.
  for (const auto& splats : {widened(inside_sphere(4000)), widened(inside_cube(25))})
    for (const DirectionPattern pattern : {DirectionPattern::stratified, DirectionPattern::hemicube}) {
      const auto h = Traced(splats).irradiance(with(256, pattern), [](const Splat&) { return 1.0; });
      const double least = *std::min_element(h.begin(), h.end());
      const double mean = std::accumulate(h.begin(), h.end(), 0.0) / static_cast<double>(h.size());
      CAPTURE(splats.size(), least, mean, static_cast<int>(pattern));
      CHECK(mean == Approx(1.0).epsilon(2e-3));
      CHECK(least > 0.97); // of 256 rays of the worst point
      CHECK(*std::max_element(h.begin(), h.end()) < 1.0 + 1e-5);
    }
}

TEST_CASE("directions on the device: what a face of a cube gives each point of the opposite one, by the closed form") {
  const Traced cube(inside_cube(25));
  const auto floor = [](const Splat& s) { return s.normal[2] > 0.9f; };
  double before = INFINITY;
  for (const unsigned count : {64u, 256u, 1024u}) {
    const auto h = cube.irradiance(with(count), [&](const Splat& s) { return floor(s) ? 1.0 : 0.0; });
    double square = 0.0, bias = 0.0;
    int points = 0;
    for (std::size_t i = 0; i < cube.places.size(); ++i) {
      const Splat& s = cube.points()[i];
      if (!(s.normal[2] < -0.9f)) continue;
      // Lengths in sides of the cube, whose face lies 1 away.
      const double x = (s.position[0] - 0.1) / 0.8, y = (s.position[1] - 0.1) / 0.8;
      const double truth = corner(x, y) + corner(1 - x, y) + corner(x, 1 - y) + corner(1 - x, 1 - y);
      square += (h[3 * i] - truth) * (h[3 * i] - truth);
      bias += h[3 * i] - truth;
      ++points;
    }
    const double error = std::sqrt(square / points);
    CAPTURE(count, error);
    CHECK(std::fabs(bias / points) < 0.002); // of 0.2: no light is lost or won
    // Strata cut by the border of the face count at random: n^(-3/4); without strata n^(-1/2), half at each step.
    CHECK(error < 0.45 * before);
    before = error;
  }
  CHECK(before < 0.004);
}

TEST_CASE("directions on the device: the same in both forms of the octree, with hits kept or traced again") {
  const auto splats = room_splats(1500);
  const auto bright = [](const Splat& s) { return 0.2 + double{s.position[0]}; };
  const Traced wide(splats), step(splats, TraversalForm::step);
  const auto kept = wide.irradiance(with(64), bright);
  CHECK(relative_l2(step.irradiance(with(64), bright), kept) < 1e-3); // a ray in a thousand meets a rim in one of them
  std::vector<double> b, h;
  for (const Splat& s : wide.points())
    b.insert(b.end(), 3, bright(s));
  const DeviceDirections all(session(), wide.pools, wide.variant, wide.points(), wide.places, with(64));
  for (const std::uint64_t bytes : {1u, 100'000u}) { // nothing fits, some does
    DirectionsOptions options = with(64);
    options.memory_bytes = bytes;
    DeviceDirections some(session(), wide.pools, wide.variant, wide.points(), wide.places, options);
    CAPTURE(bytes);
    CHECK(some.kept_bytes() <= bytes);
    CHECK((some.kept_bytes() > 0) == (bytes > 1));
    const std::uint64_t kept_rays = some.rays();
    for (const unsigned applies : {1u, 2u}) {
      some.apply(b, LinearisationPoint::current, h);
      CHECK(h == kept);
      CHECK(some.rays() == kept_rays + applies * (all.rays() - kept_rays)); // those of the rest, at each apply
    }
  }
}

TEST_CASE("directions on the device: rays and bytes are points times directions, and no ray is traced twice") {
  const Traced room(inside_cube(15));
  const std::size_t points = room.places.size();
  REQUIRE(points % BEAM_RAYS != 0);
  DeviceDirections exchange(session(), room.pools, room.variant, room.points(), room.places, with(100));
  CHECK(exchange.directions() == 100);
  CHECK(exchange.rays() == 100 * points); // a closed cube has no rims that rays would go past
  CHECK(exchange.kept_bytes() == 4 * 100 * ((points + BEAM_RAYS - 1) / BEAM_RAYS * BEAM_RAYS));
  CHECK(exchange.beam_rays() == 0); // grouping ray
  std::vector<double> b(3 * points, 1.0), h, again;
  exchange.apply(b, LinearisationPoint::current, h);
  for (double& value : b)
    value = -2.0;
  exchange.apply(b, LinearisationPoint::kept, again);
  CHECK(exchange.rays() == 100 * points);
  for (std::size_t i = 0; i < h.size(); ++i)
    CHECK(again[i] == -2.0 * h[i]); // linear
  CHECK_THROWS_AS(exchange.apply(View<double>(b.data(), 3), LinearisationPoint::current, h), std::invalid_argument);
  DeviceDirections none(session(), room.pools, room.variant, room.points(), {}, with(100));
  none.apply({}, LinearisationPoint::current, h);
  CHECK(h.empty());
}

TEST_CASE("directions on the device: beams see what single rays see, bit for bit", "[long]") {
  TraversalVariant single = plain_variant(TraversalForm::wide);
  if (!session().info().is_cpu) {
    WARN("no CPU device: it has no beams");
    return;
  }
  struct Case {
    const char* name;
    std::vector<Splat> splats;
    bool clipped;
    double least_in_beams; ///< share of the directions
  };
  std::vector<Splat> flat = room_splats(1500);
  for (Splat& s : flat)
    s.material += FLAT;
  // Random discs and sheets see the outside: rays that meet nothing; their beams give up or never begin.
  const std::vector<Case> cases{{"room", room_splats(3000), false, 0.2},
                                {"room, clipped", room_splats(1500), true, 0.1},
                                {"room, flat and clipped", flat, true, 0.1},
                                {"sheets", sheet_splats(room_splats(1500)), false, 0.1},
                                {"sheets, clipped", sheet_splats(inside_sphere(1500)), true, 0.1},
                                {"planes", plane_splats(14), false, 0.1},
                                {"all sorts", mixed_splats(), false, -1.0}};
  std::mt19937 g(11);
  for (const Case& c : cases)
    for (const unsigned lanes : {8u, 16u}) {
      single.lanes = lanes;
      single.clips = c.clipped;
      TraversalVariant packets = single;
      packets.grouping = RayGrouping::packet;
      REQUIRE(directions_in_beams(packets, false));
      const SplatClips clips = c.clipped ? random_clips(c.splats, 7) : SplatClips{};
      Traced rays(c.splats, single, clips);
      Traced beams(c.splats, packets, clips);
      // A colour of its own a point: sums are the same where hits are.
      std::vector<double> b(3 * rays.places.size());
      for (double& value : b)
        value = std::uniform_real_distribution<double>(0.0, 1.0)(g);
      double in_beams = 0.0; // share of the directions last traced
      const auto seen = [&](const Traced& traced, std::uint64_t memory_bytes) {
        DirectionsOptions options = with(100);
        options.memory_bytes = memory_bytes;
        DeviceDirections exchange(session(), traced.pools, traced.variant, traced.points(), traced.places, options);
        std::vector<double> given, h;
        for (const std::uint32_t p : traced.places)
          given.insert(given.end(), b.begin() + 3 * p, b.begin() + 3 * p + 3);
        exchange.apply(given, LinearisationPoint::current, h);
        in_beams = static_cast<double>(exchange.beam_rays()) / (100.0 * static_cast<double>(traced.places.size()));
        return h;
      };
      const std::vector<double> truth = seen(rays, 0);
      CAPTURE(c.name, lanes);
      CHECK(in_beams == 0.0);
      CHECK(differences(seen(beams, 0), truth) == 0);
      CAPTURE(in_beams);
      CHECK(in_beams > c.least_in_beams);
      CHECK(in_beams < 0.99);                               // some are single rays
      CHECK(differences(seen(beams, 300'000), truth) == 0); // some hits are kept
      beams.places.resize(beams.places.size() - 7);         // the last block is not whole
      rays.places = beams.places;
      CHECK(differences(seen(beams, 0), seen(rays, 0)) == 0);
    }
}

TEST_CASE("directions on the device: the sky that points see is the closed form's, even or a clear sky's map") {
  std::vector<Splat> splats;
  add_quad(splats, 40, {0.05, 0.05, 0.5}, {0.9, 0.0, 0.0}, {0.0, 0.9, 0.0}, {0.0, 0.0, 1.0}, 0.81);
  const SkyFrame frame = sky_frame(UpAxis::z, 0.0);
  auto map = std::make_shared<EnvironmentMap>(
      make_environment_map(sky_image(make_sky_model(frame, 120.0, 40.0, 3.0, 0.2), frame, 128, 64), frame, 1.0, "sky"));
  for (const DirectionPattern pattern : {DirectionPattern::stratified, DirectionPattern::hemicube})
    for (const bool mapped : {false, true}) {
      DeviceLighting lighting;
      lighting.has_environment = true;
      lighting.radiance.scale = mapped ? 4.0 : 1.0;
      std::copy_n(std::array<float, 3>{0.5f, 1.0f, 2.0f}.data(), 3, lighting.params.environment);
      if (mapped) {
        lighting.sky = map;
        lighting.smooth_sky = smooth_sky(*map, lighting.radiance.scale);
      }
      const Traced traced(splats);
      DeviceDirections exchange(session(), traced.pools, traced.variant, traced.points(), traced.places,
                                with(256, pattern));
      const std::vector<float> sky = exchange.sky(lighting);
      REQUIRE(sky.size() == 3 * splats.size());
      Vector3d mean = Vector3d::Zero();
      for (std::size_t i = 0; i < sky.size(); ++i)
        mean[static_cast<Eigen::Index>(i % 3)] += double{sky[i]} / static_cast<double>(splats.size());
      const Vector3d truth =
          mapped ? Vector3d(irradiance(*map, Vector3d::UnitZ()) / 4.0) : Vector3d(Vector3d(0.5, 1.0, 2.0) * 3.14159265);
      CAPTURE(mapped, mean.transpose(), truth.transpose());
      // Of an even sky nothing is drawn. A hemicube's own sums are off by its cells; the map's texels, and what 1600
      // points draw, by less than 1 % together.
      CHECK((mean - truth).norm() < (mapped ? 0.01 : 1e-4) * truth.norm());
      const Traced closed(widened(inside_sphere(4000)));
      const std::vector<float> nothing =
          DeviceDirections(session(), closed.pools, closed.variant, closed.points(), closed.places, with(64, pattern))
              .sky(lighting);
      // Of 256,000 rays one has found a pinhole between the discs.
      CHECK(std::count(nothing.begin(), nothing.end(), 0.0f) >= static_cast<std::ptrdiff_t>(nothing.size()) - 9);
    }
}

TEST_CASE("directions on the device: the sky is the same in beams or not, with hits kept or traced again, with gaps in "
          "places") {
  const auto splats = room_splats(1500);
  const SkyFrame frame = sky_frame(UpAxis::z, 0.0);
  DeviceLighting lighting;
  lighting.has_environment = true;
  lighting.sky = std::make_shared<EnvironmentMap>(
      make_environment_map(sky_image(make_sky_model(frame, 120.0, 40.0, 3.0, 0.2), frame, 128, 64), frame, 1.0, "sky"));
  lighting.smooth_sky = smooth_sky(*lighting.sky, 1.0);
  TraversalVariant packets = plain_variant(TraversalForm::wide);
  packets.grouping = RayGrouping::packet;
  const Traced traced(splats);
  const auto sky_of = [&](const TraversalVariant& variant, const std::vector<std::uint32_t>& places,
                          std::uint64_t bytes) {
    DirectionsOptions options = with(64);
    options.memory_bytes = bytes;
    return DeviceDirections(session(), traced.pools, variant, traced.points(), places, options).sky(lighting);
  };
  const std::vector<float> all = sky_of(traced.variant, traced.places, 0);
  CHECK(*std::max_element(all.begin(), all.end()) > 0.0f); // the room has a gap
  CHECK(sky_of(traced.variant, traced.places, 100'000) == all);
  std::vector<std::uint32_t> some;
  for (std::uint32_t place = 0; place < traced.places.size(); ++place)
    if (place % 3 != 1) some.push_back(place);
  const std::vector<float> of_some = sky_of(traced.variant, some, 0);
  std::size_t different = 0;
  for (std::size_t i = 0; i < of_some.size(); ++i)
    different += of_some[i] != all[3 * some[i / 3] + i % 3];
  CHECK(different == 0);
  if (session().info().is_cpu) {
    CHECK(sky_of(packets, traced.places, 0) == all);
    CHECK(sky_of(packets, some, 0) == of_some);
  }
}
