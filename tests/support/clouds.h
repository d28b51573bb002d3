#pragma once
/// Small synthetic splat sets in the root cube.
#include "octree/splat.h"
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

namespace pointgi::test {

inline Splat make_splat(float x, float y, float z, float nx, float ny, float nz, float radius) {
  Splat s{};
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  const float position[3] = {x, y, z}, normal[3] = {nx / length, ny / length, nz / length};
  for (int a = 0; a < 3; ++a) {
    s.position[a] = position[a];
    s.normal[a] = normal[a];
    s.colour[a] = 0.5f;
  }
  s.radius = radius;
  s.area = 3.14159265f * radius * radius;
  return s;
}

/// Discs anywhere, facing anywhere, of radii from far below to far above a leaf's cell; all inside the cube.
inline std::vector<Splat> random_splats(std::size_t count, unsigned seed) {
  std::mt19937 g(seed);
  std::uniform_real_distribution<float> place(0.13f, 0.87f), exponent(-7.0f, -3.0f);
  std::normal_distribution<float> direction;
  std::vector<Splat> splats;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = place(g), y = place(g), z = place(g), nx = direction(g), ny = direction(g), nz = direction(g);
    splats.push_back(make_splat(x, y, z, nx, ny, nz, std::exp2(exponent(g))));
  }
  return splats;
}

/// A clip on each fifth of `count` splats, whose first strip ends at the splat's number.
inline SplatClips numbered_clips(std::size_t count) {
  SplatClips clips;
  for (std::uint32_t i = 0; i < count; i += 5)
    clips.push_back({i, {{{{1.0f, 0.0f, 0.0f}, -0.5f, static_cast<float>(i)}, {}}}});
  return clips;
}

/// A sphere of overlapping discs about (0.5, 0.5, 0.5).
inline std::vector<Splat> sphere_splats(std::size_t count, float radius = 0.3f) {
  std::vector<Splat> splats;
  const double golden = 3.14159265358979 * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double s = std::sqrt(1.0 - z * z), a = golden * static_cast<double>(i);
    const auto nx = static_cast<float>(s * std::cos(a)), ny = static_cast<float>(s * std::sin(a)),
               nz = static_cast<float>(z);
    splats.push_back(make_splat(0.5f + radius * nx, 0.5f + radius * ny, 0.5f + radius * nz, nx, ny, nz,
                                radius * static_cast<float>(1.2 * std::sqrt(4.0 / static_cast<double>(count)))));
  }
  return splats;
}

/// Discs on axis-parallel planes that coincide with cell borders, all of one depth: ties and borders everywhere.
inline std::vector<Splat> plane_splats(int per_side) {
  std::vector<Splat> splats;
  const float step = 0.75f / static_cast<float>(per_side);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < per_side; ++i)
      for (int j = 0; j < per_side; ++j) {
        float p[3], n[3] = {0.0f, 0.0f, 0.0f};
        p[axis] = axis == 1 ? 0.25f : 0.5f;
        p[(axis + 1) % 3] = 0.125f + step * static_cast<float>(i);
        p[(axis + 2) % 3] = 0.125f + step * static_cast<float>(j);
        n[axis] = 1.0f;
        splats.push_back(make_splat(p[0], p[1], p[2], n[0], n[1], n[2], step));
      }
  return splats;
}

/// Both sides of each splat, as those of a two-sided material.
inline std::vector<Splat> sheet_splats(const std::vector<Splat>& splats) {
  std::vector<Splat> sides;
  for (const Splat& s : splats) {
    Splat front = s, back = s;
    front.material += SHEET_FRONT;
    back.material += SHEET_BACK;
    for (float& n : back.normal)
      n = -n;
    sides.push_back(front);
    sides.push_back(back);
  }
  return sides;
}

/// All of the above but sheets in one: what a traversal is tested on.
inline std::vector<Splat> mixed_splats() {
  std::vector<Splat> all = random_splats(600, 3);
  for (const auto& part : {sphere_splats(500), plane_splats(12)})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Two strips across each other, of any width, on a third of the splats, and on both sides of a sheet alike.
inline SplatClips random_clips(const std::vector<Splat>& splats, unsigned seed) {
  std::mt19937 g(seed);
  std::uniform_real_distribution<float> share(0.0f, 1.3f), turn(0.0f, 6.28f);
  SplatClips clips;
  for (std::uint32_t i = 0; i < splats.size(); ++i) {
    if (is_back_of_sheet(splats[i])) {
      if (!clips.empty() && clips.back().splat + 1 == i) clips.push_back({i, clips.back().clip});
      continue;
    }
    if (i / 2 % 3 != 0) continue;
    const Eigen::Vector3f normal = Eigen::Map<const Eigen::Vector3f>(splats[i].normal);
    const Eigen::Vector3f u = Eigen::AngleAxisf(turn(g), normal) * normal.unitOrthogonal(), v = normal.cross(u);
    ClippedSplat clipped{i, {}};
    const Eigen::Vector3f axes[CLIP_STRIPS] = {u, i % 2 == 0 ? v : Eigen::Vector3f::Zero()};
    for (int k = 0; k < CLIP_STRIPS; ++k) {
      std::copy_n(axes[k].data(), 3, clipped.clip.strip[k].axis);
      clipped.clip.strip[k].low = -share(g) * splats[i].radius;
      clipped.clip.strip[k].high = share(g) * splats[i].radius;
    }
    clips.push_back(clipped);
  }
  return clips;
}

/// A clip for each splat; zero, which cuts nothing off, where it has none.
inline std::vector<DiscClip> of_all(const SplatClips& clips, const std::vector<Splat>& splats) {
  std::vector<DiscClip> all(splats.size());
  for (const ClippedSplat& c : clips)
    all[c.splat] = c.clip;
  return all;
}

/// A bend for each splat, a seventh of them flat, others so steep that they end at PATCH_HEIGHT; that of a sheet's back
/// is its front's from behind.
inline PatchBends random_bends(const std::vector<Splat>& splats, unsigned seed) {
  std::mt19937 g(seed);
  std::uniform_real_distribution<float> share(-1.0f, 1.0f);
  PatchBends bends;
  for (std::size_t i = 0; i < splats.size(); ++i) {
    if (is_back_of_sheet(splats[i])) {
      const PatchBend front = bends.back();
      bends.push_back({-front.xx, front.xy, -front.yy, 0.0f});
      continue;
    }
    // The steepest curvature of such a form is at most |xx + yy| / 2 + |(xx - yy, xy)| / 2.
    const float most = i % 7 == 0 ? 0.0f : 2.0f * PATCH_HEIGHT / splats[i].radius, turn = 3.14159265f * share(g);
    const float mean = most * share(g), apart = (most - std::fabs(mean)) * std::fabs(share(g));
    bends.push_back(
        {mean + apart * std::cos(turn), 2.0f * apart * std::sin(turn), mean - apart * std::cos(turn), 0.0f});
  }
  return bends;
}

} // namespace pointgi::test
