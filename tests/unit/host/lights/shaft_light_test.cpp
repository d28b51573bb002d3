/// Light through shafts against shadow rays by a linear scan, and against closed forms.
#include "host/lights/shaft_light.h"
#include "octree/ref/segment_blocked.h"
#include <catch2/catch.hpp>
#include <cmath>

using namespace pointgi;

namespace {

/// A square of splats of one height, cells of `step`, that look up (1) or down (-1).
void add_square(std::vector<Splat>& splats, float material, float y, float up, float low, float high, float step) {
  for (float x = low + step / 2; x < high; x += step)
    for (float z = low + step / 2; z < high; z += step)
      splats.push_back({{x, y, z}, 0.75f * step, {0, up, 0}, material, {0.5f, 0.5f, 0.5f}, step * step});
}

/// A floor, a lamp of radiance 1 over it, and with `table` a plate between them.
struct Hall {
  std::vector<Splat> splats;
  DeviceLighting lighting;
  std::size_t floor = 0;

  explicit Hall(bool table, bool lamp = true) {
    lighting.materials.resize(2);
    for (float& c : lighting.materials[1].emission)
      c = 1.0f;
    add_square(splats, FLAT, 0.2f, 1.0f, 0.1f, 0.9f, 0.02f);
    floor = splats.size();
    if (table) add_square(splats, FLAT, 0.4f, 1.0f, 0.4f, 0.6f, 0.02f);
    const auto first = static_cast<pg_uint>(splats.size());
    if (lamp) add_square(splats, 1.0f + FLAT, 0.8f, -1.0f, 0.45f, 0.55f, 0.01f);
    for (pg_uint i = first; i < splats.size(); ++i)
      lighting.emitters.push_back({i, 0.0f, {}});
  }

  /// Share of the lamp's points that the place on splat i sees.
  double seen(std::size_t i, float dx, float dz) const {
    Splat from = splats[i];
    from.position[0] += dx, from.position[2] += dz;
    std::size_t open = 0;
    for (const Emitter& e : lighting.emitters)
      open += segment_blocked(splats, from, splats[e.point]) ? 0u : 1u;
    return static_cast<double>(open) / static_cast<double>(lighting.emitters.size());
  }
};

/// H by a square lamp of side 2a in the plane at height h above a place below the lamp's middle, which faces it: pi L
/// times the form factor of four corners.
double under_square(double a, double h) {
  const double x = a / h, p = std::sqrt(1.0 + x * x);
  return 4.0 * (x / p * std::atan(x / p)); // pi * 4 * (2 x / p atan(x / p)) / (2 pi)
}

} // namespace

TEST_CASE("points that know their light see all of the lamp, from every place on their discs", "[long]") {
  const Hall hall(true);
  const ShaftLight light = light_through_shafts(hall.splats, hall.lighting);
  std::size_t known = 0, open = 0;
  for (std::size_t i = 0; i < hall.floor; ++i) {
    const float r = 0.7f * hall.splats[i].radius;
    double least = 1.0, most = 0.0;
    for (const float dx : {-r, 0.0f, r})
      for (const float dz : {-r, 0.0f, r}) {
        least = std::min(least, hall.seen(i, dx, dz));
        most = std::max(most, hall.seen(i, dx, dz));
      }
    open += least == 1.0 ? 1u : 0u;
    if (light.known[i] == 0) continue;
    ++known;
    CAPTURE(i, hall.splats[i].position[0], hall.splats[i].position[2]);
    CHECK(least == 1.0);
  }
  CAPTURE(known, open);
  CHECK(10 * known > 8 * open); // shafts are wider than what is in them
  CHECK(known < hall.floor);
}

TEST_CASE("light through shafts is the lamp's closed form") {
  const Hall hall(false);
  const ShaftLight light = light_through_shafts(hall.splats, hall.lighting);
  const double exact = under_square(0.05, 0.6);
  std::size_t nearest = 0;
  const auto off_middle = [&](std::size_t i) {
    return std::hypot(hall.splats[i].position[0] - 0.5f, hall.splats[i].position[2] - 0.5f);
  };
  for (std::size_t i = 0; i < hall.floor; ++i) {
    CHECK(light.known[i] == 1);
    if (off_middle(i) < off_middle(nearest)) nearest = i;
  }
  // A centimetre off the middle and a lamp of discs: 1e-3.
  for (int c = 0; c < 3; ++c)
    CHECK(light.irradiance[3 * nearest + static_cast<std::size_t>(c)] == Approx(exact).epsilon(2e-3));
  for (std::size_t i = hall.floor; i < hall.splats.size(); ++i) { // the lamp does not light its own front
    CHECK(light.known[i] == 1);
    CHECK(light.irradiance[3 * i] == 0.0f);
  }
}

TEST_CASE("lights without a size and the sun light points by their formula, behind obstacles none") {
  Hall hall(true, false);
  LightSource light{};
  const auto type = GENERATE(LIGHT_POINT, LIGHT_DIRECTIONAL, LIGHT_SUN);
  light.type = type;
  light.strength[0] = light.strength[1] = light.strength[2] = 2.0f;
  const float place[3] = {0.5f, 0.9f, 0.5f}, above[3] = {0.0f, 1.0f, 0.0f};
  std::copy_n(type == LIGHT_POINT ? place : above, 3, light.vector);
  light.sine2 = type == LIGHT_SUN ? 2.2e-5f : 0.0f;
  hall.lighting.light_sources.push_back(light);
  const ShaftLight found = light_through_shafts(hall.splats, hall.lighting);
  std::size_t known = 0;
  for (std::size_t i = 0; i < hall.floor; ++i) {
    const Splat& s = hall.splats[i];
    const bool below = std::fabs(s.position[0] - 0.5f) < 0.1f && std::fabs(s.position[2] - 0.5f) < 0.1f;
    if (below) CHECK(found.known[i] == 0);
    if (found.known[i] == 0) continue;
    ++known;
    const double dx = s.position[0] - 0.5, dz = s.position[2] - 0.5, d2 = dx * dx + dz * dz + 0.49;
    const double exact = type == LIGHT_POINT ? 2.0 * 0.7 / (d2 * std::sqrt(d2)) : 2.0;
    CHECK(found.irradiance[3 * i] == Approx(exact).epsilon(1e-4));
  }
  CHECK(known > hall.floor * 3 / 4);
}

TEST_CASE("where rays find no light about a whole leaf its points know that, and nowhere near light") {
  const Hall hall(true);
  ShaftLight light = light_through_shafts(hall.splats, hall.lighting);
  const std::vector<std::uint8_t> before = light.known;
  const auto off_middle = [&](std::size_t i) {
    return std::max(std::fabs(hall.splats[i].position[0] - 0.5f), std::fabs(hall.splats[i].position[2] - 0.5f));
  };
  // Of the unknown points under the plate the innermost are dark, as by rays.
  const auto is_dark = [&](std::size_t i) { return i < hall.floor && off_middle(i) < 0.1f; };
  std::vector<float> by_rays(3 * hall.splats.size(), 0.5f);
  for (std::size_t i = 0; i < hall.splats.size(); ++i)
    if (is_dark(i)) std::fill_n(&by_rays[3 * i], 3, 0.0f);
  add_light_by_rays(by_rays, light);
  CHECK(light.shafts == nullptr);
  std::size_t count = 0, now_dark = 0;
  for (std::size_t i = 0; i < hall.splats.size(); ++i) {
    count += light.known[i];
    CHECK(light.known[i] >= before[i]);
    if (before[i] != 0) continue;
    CHECK(light.irradiance[3 * i] == by_rays[3 * i]);
    if (light.known[i] == 0) continue;
    ++now_dark;
    CHECK(is_dark(i));
    CHECK(off_middle(i) < 0.1f - 2.0f * hall.splats[i].radius); // none whose disc, or neighbour, light may reach
  }
  CHECK(count == light.known_points);
  CHECK(now_dark > 0);
}

TEST_CASE("nothing is known of more lamps than shafts are worth, nor without splats") {
  Hall hall(false);
  for (std::size_t k = 0; k <= most_lamps; ++k)
    hall.lighting.light_sources.push_back(LightSource{{0.5f, 0.7f, 0.5f}, LIGHT_POINT, {1, 1, 1}, 1.0f, 0.0f, {}});
  CHECK(light_through_shafts(hall.splats, hall.lighting).known_points == 0);
  CHECK(light_through_shafts(std::vector<Splat>{}, hall.lighting).known.empty());
}
