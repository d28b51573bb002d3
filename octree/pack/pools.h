#pragma once
/// The packed octree in either device form, and what is told of it whatever the form.
#include "octree/pack/step_pools.h"
#include "octree/pack/wide_pools.h"
#include <variant>

namespace pointgi {

using OctreePools = std::variant<StepPools, WidePools>;

struct OctreeSummary {
  const char* form = "";
  std::size_t points = 0, nodes = 0, leaves = 0, extra_splats = 0, bytes = 0;
  unsigned depth = 0;
};

inline OctreeSummary summary_of(const StepPools& p) {
  return {"step", p.points.size(), p.nodes.size(), p.leaves, p.extra_splats, p.bytes(), p.depth};
}
inline OctreeSummary summary_of(const WidePools& p) {
  return {"wide", p.points.size(), p.nodes.size(), p.leaves, 0, p.bytes(), p.depth};
}
inline OctreeSummary summary_of(const OctreePools& pools) {
  return std::visit([](const auto& p) { return summary_of(p); }, pools);
}

/// The point pool, along the curve.
inline const Pool<OctreePoint>& points_of(const OctreePools& pools) {
  return std::visit([](const auto& p) -> const Pool<OctreePoint>& { return p.points; }, pools);
}
/// Input index of each point of the pool.
inline const Pool<std::uint32_t>& source_of(const OctreePools& pools) {
  return std::visit([](const auto& p) -> const Pool<std::uint32_t>& { return p.source; }, pools);
}

/// Those of the points of the pool that end at borders.
inline const SplatClips& clips_of(const OctreePools& pools) {
  return std::visit([](const auto& p) -> const SplatClips& { return p.clips; }, pools);
}

/// How the patches of the points of the pool stand off their discs; empty where all are discs.
inline const PatchBends& bends_of(const OctreePools& pools) {
  return std::visit([](const auto& p) -> const PatchBends& { return p.bends; }, pools);
}

} // namespace pointgi
