#include "host/passes/variant.h"
#include "host/photon/device_photon_map.h"
#include "host/photon/trace_photons.h"
#include "tests/support/device.h"
#include "tests/support/photons.h"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <set>

using namespace pointgi;
using namespace pointgi::test;

namespace {

struct Found {
  std::vector<std::vector<float>> distance2; ///< ascending, a list a place
  std::vector<std::vector<cl_uint>> photon;
};

Found ask_device(const std::vector<Photon>& photons, const std::vector<cl_float4>& places, unsigned k,
                 double radius = INFINITY) {
  const DevicePhotonMap map = upload_photon_map(session(), build_photon_map(photons), k, radius);
  const auto device_places = session().upload(places);
  const auto distance2 = session().allocate<float>(places.size() * k);
  const auto photon = session().allocate<cl_uint>(places.size() * k);
  const auto found = session().allocate<cl_uint>(places.size());
  const Program program = nearest_photons_program(k);
  cl::Kernel kernel = session().kernel(program.file, program.options, "nearest_of_places");
  session().launch(kernel, LaunchShape::line((places.size() + PHOTON_PLACES_AT_ONCE - 1) / PHOTON_PLACES_AT_ONCE),
                   map.nodes, map.buckets, map.params, device_places, distance2, photon, found,
                   static_cast<cl_uint>(places.size()));
  const auto d = session().download(distance2, places.size() * k);
  const auto p = session().download(photon, places.size() * k);
  const auto n = session().download(found, places.size());
  Found result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    REQUIRE(n[i] <= k);
    result.distance2.emplace_back(&d[i * k], &d[i * k] + n[i]);
    std::sort(result.distance2.back().begin(), result.distance2.back().end());
    result.photon.emplace_back(&p[i * k], &p[i * k] + n[i]);
  }
  return result;
}

std::vector<std::vector<float>> ask_flann(const std::vector<Photon>& photons, const std::vector<cl_float4>& places,
                                          unsigned k) {
  std::vector<float> rows, asked;
  for (const Photon& p : photons)
    rows.insert(rows.end(), p.position, p.position + 3);
  for (const cl_float4& p : places)
    asked.insert(asked.end(), p.s, p.s + 3);
  flann::KDTreeSingleIndex<flann::L2_3D<float>> index(flann::Matrix<float>(rows.data(), photons.size(), 3),
                                                      flann::KDTreeSingleIndexParams(12));
  index.buildIndex();
  std::vector<std::vector<std::size_t>> indices;
  std::vector<std::vector<float>> distances;
  index.knnSearch(flann::Matrix<float>(asked.data(), places.size(), 3), indices, distances, k, flann::SearchParams(-1));
  return distances;
}

std::vector<cl_float4> some_places(std::size_t count, unsigned seed) {
  std::mt19937 g(seed);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  std::vector<cl_float4> places;
  for (const Photon& p : caustic_photons(count / 2, seed))
    places.push_back({{p.position[0], p.position[1], p.position[2], 0.0f}});
  while (places.size() < count) // off the floor, outside the photons' boxes
    places.push_back({{1.5f * u(g) - 0.2f, 1.5f * u(g) - 0.2f, u(g), 0.0f}});
  return places;
}

/// Distances in float from other orders of the sums: a few roundings apart; the difference of coordinates below 1 that
/// are rounded to 6e-8 is what small distances have.
void require_same(const std::vector<std::vector<float>>& a, const std::vector<std::vector<float>>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].size() == b[i].size());
    for (std::size_t j = 0; j < a[i].size(); ++j) {
      CAPTURE(i, j);
      REQUIRE(a[i][j] == Approx(b[i][j]).epsilon(1e-6).margin(1e-14));
    }
  }
}

} // namespace

TEST_CASE("nearest photons are FLANN's: one, fifty, five hundred, a thousand of 100,000", "[long]") {
  const auto photons = caustic_photons(100'000, 1);
  const auto places = some_places(1003, 2); // no whole number of work-items
  for (const unsigned k : {1u, 50u, 500u, 1000u}) {
    CAPTURE(k);
    const Found found = ask_device(photons, places, k);
    require_same(found.distance2, ask_flann(photons, places, k));
    for (const auto& of_place : found.photon)
      REQUIRE(std::set<cl_uint>(of_place.begin(), of_place.end()).size() == k);
  }
}

TEST_CASE("nearest photons where many lie in one place, are too few, too far, or none") {
  const float down[3] = {0.0f, 0.0f, -1.0f};
  const auto places = some_places(200, 3);
  SECTION("each place holds forty") {
    auto photons = caustic_photons(200, 4);
    for (int copies = 1; copies < 40; ++copies)
      photons.insert(photons.end(), photons.begin(), photons.begin() + 200);
    for (const unsigned k : {1u, 50u, 500u})
      require_same(ask_device(photons, places, k).distance2, ask_flann(photons, places, k));
  }
  SECTION("all lie in one place, more than the list has room for") {
    const std::vector<Photon> photons(20'000, make_photon(0.25f, 0.5f, 0.75f, down));
    for (const unsigned k : {1u, 50u, 500u}) {
      const Found found = ask_device(photons, places, k);
      require_same(found.distance2, ask_flann(photons, places, k));
      for (const auto& of_place : found.photon)
        REQUIRE(std::set<cl_uint>(of_place.begin(), of_place.end()).size() == k);
    }
  }
  SECTION("fewer than k") {
    const auto photons = caustic_photons(37, 5);
    const Found found = ask_device(photons, places, 50);
    require_same(found.distance2, ask_flann(photons, places, 37));
  }
  SECTION("some within the radius") {
    const auto photons = caustic_photons(2000, 6);
    const double radius = 0.06;
    auto truth = ask_flann(photons, places, 50);
    std::size_t cut = 0;
    for (auto& of_place : truth) {
      const auto end = std::lower_bound(of_place.begin(), of_place.end(), static_cast<float>(radius * radius));
      cut += end != of_place.end() && end != of_place.begin();
      of_place.erase(end, of_place.end());
    }
    CHECK(cut > 10); // or this would test nothing
    require_same(ask_device(photons, places, 50, radius).distance2, truth);
  }
  SECTION("on a lattice, some in many copies") {
    // Coordinates are small multiples of 1/16, so that distances that should tie do; 5 copies of every third.
    const auto part = [](int i, int of) { return static_cast<float>(i) / static_cast<float>(of); };
    std::vector<Photon> photons;
    for (int i = 0; i < 17 * 17 * 17; ++i)
      for (int copy = 0; copy < (i % 3 == 0 ? 5 : 1); ++copy)
        photons.push_back(make_photon(part(i % 17, 16), part(i / 17 % 17, 16), part(i / 289, 16), down));
    std::vector<cl_float4> on_lattice;
    for (int i = 0; i < 200; ++i) // points, and middles of edges, faces and cells
      on_lattice.push_back({{part(i % 33, 32), part(i * 7 % 33, 32), part(i * 5 % 33, 32), 0.0f}});
    for (const unsigned k : {1u, 50u, 500u}) {
      CAPTURE(k);
      const Found found = ask_device(photons, on_lattice, k);
      require_same(found.distance2, ask_flann(photons, on_lattice, k));
      for (const auto& of_place : found.photon)
        REQUIRE(std::set<cl_uint>(of_place.begin(), of_place.end()).size() == k);
    }
  }
  SECTION("most of them exactly as far off as counts no more") {
    // Each bucket holds one nearer photon or more, beside many at the radius: 48 places from (1, 2, 5) / 32 by signs
    // and orders, whose distances squared are exactly 30 / 1024.
    std::vector<Photon> photons;
    std::size_t nearer = 0;
    for (int sign = 0; sign < 8; ++sign)
      for (const auto& order : {std::array<int, 3>{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
        const float part[3] = {1.0f / 32, 2.0f / 32, 5.0f / 32};
        float at[3];
        for (int a = 0; a < 3; ++a)
          at[a] = (sign >> a & 1) != 0 ? -part[order[a]] : part[order[a]];
        const std::size_t copies = 100;
        for (std::size_t copy = 0; copy < copies; ++copy) {
          const bool near = copy % 100 == 99;
          nearer += near;
          const float shrink = near ? 0.96875f : 1.0f;
          photons.push_back(make_photon(0.5f + shrink * at[0], 0.5f + shrink * at[1], 0.5f + shrink * at[2], down));
        }
      }
    const std::vector<cl_float4> middle(1, {{0.5f, 0.5f, 0.5f, 0.0f}});
    const double radius = std::sqrt(30.0 / 1024.0);
    for (const unsigned k : {1u, 50u, 500u}) {
      const Found found = ask_device(photons, middle, k, radius);
      CHECK(found.distance2[0].size() == std::min<std::size_t>(k, nearer));
      for (const float d2 : found.distance2[0])
        CHECK(d2 < 30.0f / 1024.0f);
    }
  }
  SECTION("none") {
    for (const auto& of_place : ask_device({}, places, 50).distance2)
      CHECK(of_place.empty());
  }
}

namespace {

/// Irradiance of a place that faces upwards, by sorting all photons: kernels/photon/gather.cl says what counts.
double irradiance_by_sorting(const std::vector<Photon>& photons, const cl_float4& place, unsigned k, double radius) {
  std::vector<std::pair<double, double>> found; // distance squared, power
  for (const Photon& p : photons) {
    const double x = p.position[0] - place.s[0], y = p.position[1] - place.s[1], z = p.position[2] - place.s[2];
    const double d2 = x * x + y * y + 16.0 * z * z;
    float direction[3];
    unpack_direction(p.inward, direction);
    if (d2 < radius * radius && direction[2] < 0.0f) found.emplace_back(d2, p.power[1]);
  }
  std::sort(found.begin(), found.end());
  const bool enough = found.size() >= k;
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(k, found.size()); ++i)
    sum += found[i].second;
  const double share = enough && k > 1 ? (k - 1.0) / k : 1.0;
  return share * sum / (3.14159265358979 * (enough ? found[k - 1].first : radius * radius));
}

} // namespace

TEST_CASE("irradiance by photons is that of all photons sorted") {
  std::mt19937 g(7);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  std::vector<Photon> photons = caustic_photons(10'000, 8);
  for (Photon& p : photons) {
    const float up[3] = {0.0f, 0.6f, 0.8f}, down[3] = {0.6f, 0.0f, -0.8f};
    p.inward = packed_direction(u(g) < 0.2f ? up : down);
    p.position[2] += 0.002f * u(g);
    p.power[0] = p.power[1] = p.power[2] = u(g) * u(g) * u(g);
  }
  const double radius = 0.08;
  std::vector<cl_float4> places;
  for (const cl_float4& place : some_places(200, 9)) {
    places.push_back({{place.s[0], place.s[1], 0.3f, 0.0f}});
    places.push_back({{0.0f, 0.0f, 1.0f, 0.0f}});
  }
  for (const unsigned k : {1u, 16u, 50u, 500u}) {
    const DevicePhotonMap map = upload_photon_map(session(), build_photon_map(photons), k, radius);
    const std::vector<cl_float4> found = caustic_irradiance(session(), map, places);
    for (std::size_t i = 0; i < found.size(); ++i) {
      CAPTURE(k, i);
      // The farthest photon's distance squared, in float from coordinates rounded to 6e-8: a few 1e-4 of it where it is
      // as small as 3e-4 squared, which only k = 1 has.
      REQUIRE(found[i].s[1] ==
              Approx(irradiance_by_sorting(photons, places[2 * i], k, radius)).epsilon(k == 1 ? 2e-3 : 1e-4));
    }
  }
}
