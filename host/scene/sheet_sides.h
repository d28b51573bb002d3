#pragma once
#include "host/scene/merge_coincident.h"
#include "host/scene/scene.h"
#include "octree/splat.h"

namespace pointgi {

/// Makes each splat of a two-sided material, and each that its structure shows to have no side (leaves, cables, faces
/// stored both ways round) where the material leaves that open, two: the front of a sheet and, behind it in the list,
/// its back, which differs in its normal alone (SHEET_FRONT, SHEET_BACK of shared/octree_types.h). Each side then has
/// light of its own, and no stage of light needs to know of sheets. `id[i]` goes with splat i; both sides have it.
/// `structure[id]`: as PointCloud has it; empty: all are surfaces. `sides`: splats that are the two sides of a sheet
/// already, each with a colour of its own (merge_coincident()). Returns how many sheets there are. Throws Error(memory)
/// where there would be more points than the octree counts.
std::size_t divide_sheets(const Scene& scene, std::vector<Splat>& splats, std::vector<std::uint32_t>& id,
                          const std::vector<Structure>& structure = {}, const std::vector<CoincidentSides>& sides = {});

} // namespace pointgi
