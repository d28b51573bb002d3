#pragma once
/// A splat in the root cube, as the octree's builders take it.
#include "octree/view.h"
#include "shared/octree_types.h"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointgi {

/// The device's own point: position in [0,1)^3, unit normal, radius > 0 (root cube units).
using Splat = OctreePoint;

/// Index into the materials.
inline std::size_t material_of(const Splat& splat) {
  return static_cast<std::size_t>(splat.material);
}

/// Whether the splat is one side of a sheet (shared/octree_types.h), and which.
inline bool is_sheet(const Splat& splat) {
  return SHEET_SIDE(splat.material) != 0.0f;
}
inline bool is_back_of_sheet(const Splat& splat) {
  return SHEET_SIDE(splat.material) == SHEET_BACK;
}

/// Whether its disc lies in the true surface (shared/octree_types.h).
inline bool is_flat(const Splat& splat) {
  return IS_FLAT(splat.material);
}

static_assert(sizeof(OctreePoint) == 16 * POINT_TEXELS, "a point is three texels");
static_assert(sizeof(OctreeNode) == 16, "a node is one texel");

/// A splat whose disc ends at a border: its index, and where.
struct ClippedSplat {
  std::uint32_t splat;
  DiscClip clip;
};

/// Those of a list of splats that are clipped, ascending by index.
using SplatClips = std::vector<ClippedSplat>;

/// Index into `clips` of each of `count` splats, given by their index; no_clip for most. Empty where there are none.
constexpr std::uint32_t no_clip = 0xffffffffu;
inline std::vector<std::uint32_t> clip_of_each(const SplatClips& clips, std::size_t count) {
  std::vector<std::uint32_t> of;
  if (!clips.empty()) of.assign(count, no_clip);
  for (std::size_t k = 0; k < clips.size(); ++k)
    of[clips[k].splat] = static_cast<std::uint32_t>(k);
  return of;
}

/// How the patches of a list of splats stand off their discs, one each; empty where all are discs.
using PatchBends = std::vector<PatchBend>;

static_assert(sizeof(PatchBend) == 16, "a bend is one texel");

/// The bends of points that came from these splats, in the order of the points; none where there are none.
template <class Sources>
PatchBends bends_along(View<PatchBend> bends, const Sources& source) {
  PatchBends along(bends.size);
  for (std::size_t k = 0; k < along.size(); ++k)
    along[k] = bends[source[k]];
  return along;
}

} // namespace pointgi
