/// What photons bring to points, found once for all views (kernels/photon/caustics_of_points.cl).
#include "host/photon/device_photon_map.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include "tests/support/photons.h"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A floor about z = 0.3 from (0.2, 0.2) to (0.8, 0.8), in waves along x whose height is `height`, 2 pi `waves` of
/// them.
struct Wavy {
  double height = 0.0, waves = 4.0;
  double z(double x) const { return 0.3 + height * std::sin(2.0 * pi * waves * x); }
  double slope(double x) const { return height * 2.0 * pi * waves * std::cos(2.0 * pi * waves * x); }
  Splat splat(double x, double y, double step) const {
    const double stretch = std::sqrt(1.0 + slope(x) * slope(x));
    Splat s = make_splat(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z(x)),
                         static_cast<float>(-slope(x) / stretch), 0.0f, static_cast<float>(1.0 / stretch),
                         static_cast<float>(0.75 * step * stretch));
    s.area = static_cast<float>(step * step * stretch);
    return s;
  }
  static constexpr double pi = 3.14159265358979;
};

std::vector<Splat> splats_of(const Wavy& floor, int per_side) {
  std::vector<Splat> splats;
  const double step = 0.6 / per_side;
  for (int i = 0; i < per_side; ++i)
    for (int j = 0; j < per_side; ++j)
      splats.push_back(floor.splat(0.2 + (i + 0.5) * step, 0.2 + (j + 0.5) * step, step));
  return splats;
}

/// Photons of power 1 / density spread evenly over the surface, jittered: irradiance 1 everywhere.
std::vector<Photon> even_photons(const Wavy& floor, int per_side) {
  std::mt19937 g(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Photon> photons;
  const double step = 0.6 / per_side;
  for (int i = 0; i < per_side; ++i)
    for (int j = 0; j < per_side; ++j) {
      const double x = 0.2 + (i + u(g)) * step, y = 0.2 + (j + u(g)) * step;
      const Splat at = floor.splat(x, y, step);
      const float inward[3] = {-at.normal[0], -at.normal[1], -at.normal[2]};
      photons.push_back(make_photon(at.position[0], at.position[1], at.position[2], inward, at.area));
    }
  return photons;
}

std::vector<cl_float4> caustics_at(const std::vector<Splat>& splats, const std::vector<Photon>& photons, unsigned k,
                                   double radius) {
  DevicePhotonMap map = upload_photon_map(session(), build_photon_map(photons), k, radius);
  store_caustics(session(), splats, std::vector<std::uint8_t>{1, 0}, map, {[] { return false; }, [](double) {}});
  return session().download(map.at_points, splats.size());
}

/// As surface_distance2 of kernels/photon/gather.cl; infinity on another side.
double distance2(const Splat& place, const float x[3], const float inward[3]) {
  double d2 = 0.0, height = 0.0, along = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double d = double{x[a]} - place.position[a];
    d2 += d * d;
    height += d * place.normal[a];
    along += double{inward[a]} * place.normal[a];
  }
  return along < 0.0 ? d2 + 15.0 * height * height : INFINITY;
}

/// Irradiance at a splat from all photons and splats, one after the other, and how far the k-th photon is.
std::pair<double, double> by_sorting(const Splat& place, const std::vector<Splat>& splats,
                                     const std::vector<Photon>& photons, unsigned k, double radius) {
  std::vector<std::pair<double, double>> found;
  for (const Photon& p : photons) {
    float inward[3];
    unpack_direction(p.inward, inward);
    const double d2 = distance2(place, p.position, inward);
    if (d2 < radius * radius) found.emplace_back(d2, p.power[1]);
  }
  std::sort(found.begin(), found.end());
  const double bound2 = found.size() >= k ? found[k - 1].first : radius * radius;
  double power = 0.0, area = 0.0;
  for (const auto& [d2, p] : found)
    power += std::max(0.0, 1.0 - d2 / bound2) * p;
  for (const Splat& s : splats) {
    float inward[3];
    for (int a = 0; a < 3; ++a)
      inward[a] = -s.normal[a];
    area += std::max(0.0, 1.0 - distance2(place, s.position, inward) / bound2) * s.area;
  }
  return {power / area, std::sqrt(bound2)};
}

} // namespace

TEST_CASE("caustics of points are those of all photons and splats") {
  const Wavy floor{0.01};
  const std::vector<Splat> splats = splats_of(floor, 30);
  std::vector<Photon> photons = caustic_photons(4000, 5); // of other heights than the floor, and far from even
  for (unsigned k : {1u, 20u, 100u}) {
    const double radius = 0.08;
    const std::vector<cl_float4> found = caustics_at(splats, photons, k, radius);
    std::size_t all = 0, some = 0, none = 0;
    for (std::size_t i = 0; i < splats.size(); i += 7) {
      const auto [irradiance, reach] = by_sorting(splats[i], splats, photons, std::max(k, 2u), radius);
      const double t = std::clamp(reach / splats[i].radius - 2.0, 0.0, 1.0), share = t * t * (3.0 - 2.0 * t);
      ++(share == 0.0 ? none : share == 1.0 ? all : some);
      CAPTURE(k, i, share);
      // Distances of 0.005 in float, from coordinates rounded to 6e-8.
      CHECK(found[i].s[3] == Approx(share).margin(1e-3));
      if (share > 0.01) CHECK(found[i].s[1] == Approx(found[i].s[3] * irradiance).epsilon(2e-3).margin(1e-9));
    }
    CHECK((k == 1 || all > 10));
    if (k == 20) CHECK((some > 5 && none > 5));
  }
}

TEST_CASE("even photons are even irradiance on waves and up to a floor's edges") {
  for (const double height : {0.0, 0.015}) {
    const Wavy floor{height};
    const std::vector<Splat> splats = splats_of(floor, 60);
    const std::vector<cl_float4> found = caustics_at(splats, even_photons(floor, 80), 100, INFINITY);
    double mean = 0.0, rim = 0.0;
    std::size_t at_rim = 0;
    for (std::size_t i = 0; i < splats.size(); ++i) {
      REQUIRE(found[i].s[3] == 1.0f);
      mean += found[i].s[1] / static_cast<double>(splats.size());
      if (splats[i].position[1] > 0.21f && splats[i].position[1] < 0.79f) continue;
      rim += found[i].s[1];
      ++at_rim;
    }
    CAPTURE(height);
    // Over a flat disc the edge would have 0.5, the waves 0.9. What the k-th photon's nearness chooses: below 1 %.
    CHECK(mean == Approx(1.0).epsilon(0.015));
    CHECK(rim / static_cast<double>(at_rim) == Approx(1.0).epsilon(0.03));
  }
}

TEST_CASE("points that show no caustics have none") {
  std::vector<Splat> splats = splats_of({}, 20);
  for (std::size_t i = 0; i < splats.size(); i += 2)
    splats[i].material = 1; // of those that do not receive
  const std::vector<cl_float4> found = caustics_at(splats, even_photons({}, 40), 100, INFINITY);
  for (std::size_t i = 0; i < splats.size(); ++i) {
    CHECK((found[i].s[3] > 0.0f) == (i % 2 == 1));
    CHECK((found[i].s[1] > 0.0f) == (i % 2 == 1));
  }
}
