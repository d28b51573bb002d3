#include "host/passes/build_pools.h"
#include "host/radiosity/point_irradiance.h"
#include "host/tune/variant_list.h"
#include "tests/support/clouds.h"
#include "tests/support/device.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;
using namespace pointgi::test;

namespace {

/// A floor at z = 0.25 that looks up, and a lid at z = 0.75 that looks down over its half x < 0.5, of small discs.
std::vector<Splat> floor_and_lid() {
  std::vector<Splat> splats;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      const float px = 0.025f + 0.05f * static_cast<float>(x), py = 0.025f + 0.05f * static_cast<float>(y);
      splats.push_back(make_splat(px, py, 0.25f, 0, 0, 1, 0.036f));
      if (x < 10) splats.push_back(make_splat(px, py, 0.75f, 0, 0, -1, 0.036f));
    }
  return splats;
}

DeviceLighting light_from(std::uint32_t type, float x, float y, float z, float strength) {
  DeviceLighting lighting;
  lighting.materials.resize(1);
  LightSource light{};
  light.vector[0] = x, light.vector[1] = y, light.vector[2] = z;
  light.type = type;
  for (float& channel : light.strength)
    channel = strength;
  light.cumulative = 1.0f;
  lighting.light_sources.push_back(light);
  lighting.light_types = 1u << type;
  lighting.params.light_sources = 1;
  lighting.params.samples = 1;
  return lighting;
}

} // namespace

TEST_CASE("direct irradiance of points: I cos / d^2 where the light reaches, nothing behind or in shadow") {
  const std::vector<Splat> splats = floor_and_lid();
  for (const TraversalForm form : {TraversalForm::step, TraversalForm::wide}) {
    const TraversalVariant variant = plain_variant(form);
    const OctreePools pools = build_pools(splats, variant);
    Session& device = session();
    const DevicePools on_device = upload_pools(device, pools, variant.storage);
    const auto measure = [&](const DeviceLighting& lighting) {
      return device.download(direct_irradiance_of_points(device, on_device, variant, lighting, 1.0, splats.size(), 1,
                                                         true, [] { return false; }),
                             3 * splats.size());
    };
    const auto point = measure(light_from(LIGHT_POINT, 0.6f, 0.5f, 0.6f, 2.0f));
    const auto sun = measure(light_from(LIGHT_DIRECTIONAL, 0.0f, 0.0f, 1.0f, 3.0f));
    const auto& in_pool = points_of(pools);
    for (std::size_t i = 0; i < splats.size(); ++i) {
      const Splat& s = in_pool[i];
      const bool is_floor = s.normal[2] > 0.0f;
      const double dx = 0.6 - s.position[0], dy = 0.5 - s.position[1], dz = 0.6 - s.position[2];
      const double d2 = dx * dx + dy * dy + dz * dz;
      const double expected = 2.0 * std::fabs(dz) / std::sqrt(d2) / d2;   // between the two: both face it
      CHECK(point[3 * i] == Approx(expected).epsilon(1e-4).margin(1e-6)); // float arithmetic
      if (!is_floor) {
        CHECK(sun[3 * i] == 0.0f);                               // its back
      } else if (s.position[0] < 0.4f || s.position[0] > 0.6f) { // the lid's rim lies between
        CHECK(sun[3 * i] == Approx(s.position[0] < 0.5f ? 0.0 : 3.0).epsilon(1e-5));
      }
      CHECK(point[3 * i] == point[3 * i + 2]);
    }
  }
}

TEST_CASE("points of a scene without light are dark, and a stop leaves the rest at nothing") {
  const std::vector<Splat> splats = floor_and_lid();
  const TraversalVariant variant = plain_variant(TraversalForm::wide);
  const OctreePools pools = build_pools(splats, variant);
  Session& device = session();
  const DevicePools on_device = upload_pools(device, pools, variant.storage);
  DeviceLighting dark;
  dark.materials.resize(1);
  dark.light_sources.clear();
  const auto none = device.download(
      direct_irradiance_of_points(device, on_device, variant, dark, 1.0, splats.size(), 4, true, [] { return false; }),
      3 * splats.size());
  CHECK(std::count(none.begin(), none.end(), 0.0f) == static_cast<std::ptrdiff_t>(none.size()));
  int asked = 0;
  const auto some = device.download(direct_irradiance_of_points(device, on_device, variant,
                                                                light_from(LIGHT_DIRECTIONAL, 0, 0, 1, 3.0f), 1.0,
                                                                splats.size(), 1, true, [&] { return ++asked > 1; }),
                                    3 * splats.size());
  const auto& in_pool = points_of(pools);
  for (std::size_t i = 256; i < splats.size(); ++i)
    CHECK(some[3 * i] == 0.0f);
  CHECK(std::count_if(some.begin(), some.begin() + 768, [](float h) { return h > 0.0f; }) > 0);
  CHECK(in_pool.size() == splats.size());
}
