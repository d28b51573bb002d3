#pragma once
/// A closed room with a bumpy body, a block and a lamp under the ceiling, ready for both ways of radiosity.
#include "host/passes/build_pools.h"
#include "host/passes/device_pools.h"
#include "host/radiosity/point_irradiance.h"
#include "host/tune/variant_list.h"
#include "tests/support/rooms.h"

namespace pointgi::test {

namespace detail {

/// A rectangle of squares about h across, in the room's unit: `corner` and the lengths along the axes after `axis`,
/// facing along `axis` up or down.
inline void add_rectangle(std::vector<Splat>& splats, int axis, double facing, std::array<double, 3> corner, double u,
                          double v, double h) {
  const int across = std::max(1, static_cast<int>(std::lround(u / h))),
            along = std::max(1, static_cast<int>(std::lround(v / h)));
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < along; ++j) {
      std::array<double, 3> p = corner, n{};
      p[(axis + 1) % 3] += u * (i + 0.5) / across;
      p[(axis + 2) % 3] += v * (j + 0.5) / along;
      n[axis] = facing;
      splats.push_back(room_splat(p, n, u / across * v / along));
    }
}

} // namespace detail

/// About `count` splats of material 0, one wall red; the lamp's are black and of material 1.
inline std::vector<Splat> lit_room_splats(std::size_t count) {
  std::vector<Splat> splats = room_splats(count * 9 / 10);
  for (Splat& s : splats)
    for (int c = 0; c < 3; ++c)
      s.colour[c] = c > 0 && s.normal[1] > 0.999f ? 0.1f : 0.7f;
  const double h = std::sqrt(32.0 / static_cast<double>(count)); // as on the walls
  const std::size_t block = splats.size();
  for (int axis = 0; axis < 3; ++axis) {
    const std::array<double, 3> low{0.55, 0.5, -1.0}, size{0.35, 0.4, 0.9};
    std::array<double, 3> high = low;
    high[axis] += size[axis];
    detail::add_rectangle(splats, axis, 1.0, high, size[(axis + 1) % 3], size[(axis + 2) % 3], h);
    if (axis != 2) detail::add_rectangle(splats, axis, -1.0, low, size[(axis + 1) % 3], size[(axis + 2) % 3], h);
  }
  const std::size_t lamp = splats.size();
  // On the ceiling: in a gap behind a lamp both solvers would answer, at each size differently, what is its surface.
  detail::add_rectangle(splats, 2, -1.0, {-0.3, -0.3, 0.995}, 0.6, 0.6, h);
  for (std::size_t i = block; i < splats.size(); ++i) {
    for (float& c : splats[i].colour)
      c = i < lamp ? 0.7f : 0.0f;
    splats[i].material = i < lamp ? 0.0f : 1.0f;
  }
  return splats;
}

/// The room's points on the device, and what its lamp of 10 W/m²/sr gives each.
struct LitRoom {
  TraversalVariant variant = plain_variant(TraversalForm::wide);
  std::vector<Splat> points; ///< of the pool
  DevicePools pools;
  std::vector<float> direct; ///< [points x 3, W/m²]

  LitRoom(Session& session, std::size_t count) {
    const OctreePools packed = build_pools(lit_room_splats(count), variant);
    points.assign(points_of(packed).begin(), points_of(packed).end());
    pools = upload_pools(session, packed, variant.storage);
    const DeviceLighting light = lighting();
    direct = session.download(
        direct_irradiance_of_points(session, pools, variant, light, 1.0, points.size(), 16, true, [] { return false; }),
        3 * points.size());
  }

  /// Albedo times all light that comes: direct and, given as direct is, from surfaces.
  std::vector<double> radiosity(const std::vector<float>& from_surfaces) const {
    std::vector<double> b(direct.size());
    for (std::size_t i = 0; i < b.size(); ++i)
      b[i] = static_cast<double>(points[i / 3].colour[i % 3]) * (static_cast<double>(direct[i]) + from_surfaces[i]);
    return b;
  }

private:
  DeviceLighting lighting() const {
    DeviceLighting light;
    light.materials.resize(2);
    for (int c = 0; c < 3; ++c)
      light.materials[1].emission[c] = 10.0f;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (points[i].material == 1.0f) light.emitters.push_back({i, 0.0f, {}});
    for (std::size_t k = 0; k < light.emitters.size(); ++k) // all of one size
      light.emitters[k].cumulative = static_cast<float>(k + 1) / static_cast<float>(light.emitters.size());
    light.params.emitters = static_cast<pg_uint>(light.emitters.size());
    light.params.samples = 1;
    return light;
  }
};

} // namespace pointgi::test
