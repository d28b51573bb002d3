#pragma once
/// The rays that every traversal must answer: random, axis-parallel, grazing, through cell corners, from planes.
#include "octree/splat.h"
#include "shared/traversal_types.h"
#include <cmath>
#include <random>
#include <vector>

namespace pointgi::test {

inline RayQuery make_ray(const float origin[3], const float direction[3], float t_max = 8.0f) {
  RayQuery ray{};
  const float length =
      std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = origin[a];
    ray.direction[a] = direction[a] / length;
  }
  ray.t_max = t_max;
  return ray;
}

/// `count` rays, a fifth of each kind.
inline std::vector<RayQuery> hard_rays(const std::vector<Splat>& splats, std::size_t count, unsigned seed) {
  std::mt19937 g(seed);
  std::uniform_real_distribution<float> anywhere(-0.3f, 1.3f), inside(0.0f, 1.0f);
  std::normal_distribution<float> gauss;
  std::uniform_int_distribution<std::size_t> pick(0, splats.size() - 1);
  std::uniform_int_distribution<int> axis_of(0, 2), corner(0, 64);
  std::vector<RayQuery> rays;
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    float o[3], d[3] = {gauss(g), gauss(g), gauss(g)};
    const Splat& s = splats[pick(g)];
    switch (i % 5) {
    case 0: // from anywhere towards anywhere in the cube
      for (int a = 0; a < 3; ++a) {
        o[a] = anywhere(g);
        d[a] = inside(g) - o[a];
      }
      break;
    case 1: { // along an axis, at times exactly on the planes of cells
      const int axis = axis_of(g);
      for (int a = 0; a < 3; ++a) {
        o[a] = i % 2 == 0 ? inside(g) : static_cast<float>(corner(g)) / 64.0f;
        d[a] = a == axis ? (gauss(g) < 0.0f ? -1.0f : 1.0f) : 0.0f;
      }
      o[axis] = d[axis] > 0.0f ? -0.1f : 1.1f;
      break;
    }
    case 2: { // grazing a disc: nearly in its plane, through its middle
      float along[3] = {gauss(g), gauss(g), gauss(g)}, dot = 0.0f;
      for (int a = 0; a < 3; ++a)
        dot += along[a] * s.normal[a];
      for (int a = 0; a < 3; ++a) {
        d[a] = along[a] - dot * s.normal[a] + 1e-3f * gauss(g) * s.normal[a];
        o[a] = s.position[a] - 0.7f * d[a];
      }
      break;
    }
    case 3: // through a corner where eight cells meet
      for (int a = 0; a < 3; ++a) {
        o[a] = static_cast<float>(corner(g)) / 64.0f;
        d[a] = static_cast<float>(corner(g)) / 64.0f - o[a] + (a == 0 ? 1e-30f : 0.0f);
      }
      if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < 1e-6f) d[axis_of(g)] = 1.0f;
      break;
    default: // starting on the plane of a disc
      for (int a = 0; a < 3; ++a)
        o[a] = s.position[a];
      break;
    }
    rays.push_back(make_ray(o, d));
  }
  return rays;
}

/// Narrow bundles and wide ones, along axes, across the octants, from inside discs; three bundles with wide gaps
/// between, one of them behind the others' middle; and half a sphere's width.
inline std::vector<RayQuery> bundles(const std::vector<Splat>& splats) {
  std::vector<RayQuery> rays;
  const auto middles = hard_rays(splats, 1500, 41);
  std::mt19937 g(43);
  std::normal_distribution<float> gauss;
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const float spread = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 1e-3f : i % 4 == 2 ? 0.05f : 1.0f;
    const float apart[3][3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {-0.7f, -0.7f, 0.1f}};
    for (int k = 0; k < PACKET_RAYS; ++k) {
      float d[3];
      for (int a = 0; a < 3; ++a)
        d[a] = i % 8 == 1   ? apart[k % 3][a] + 1e-3f * gauss(g)
               : i % 8 == 5 ? middles[i].direction[a] + 0.5f * gauss(g)
                            : middles[i].direction[a] + spread * gauss(g);
      rays.push_back(make_ray(middles[i].origin, d));
    }
  }
  return rays;
}

} // namespace pointgi::test
