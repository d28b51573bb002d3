#pragma once
/// The stages of indirect light, between the octree and the picture: which the scene needs, and what they found.
#include "host/app/stages.h"
#include "host/passes/radiosity.h"
#include "host/scene/frame.h"
#include <functional>
#include <optional>

namespace pointgi {

/// What there is of indirect light for the picture.
struct IndirectLight {
  std::optional<Buffer<cl_float4>> irradiance; ///< of each point of the pool, from surfaces; absent: no such light
  LinkStatistics links;
  Solution solution;
  std::uint64_t rays = 0; ///< that decided which points see each other
};

/// The scene as the stages before have left it.
struct IndirectRequest {
  const TraversalVariant& variant;
  const Scene& scene;
  const Frame& frame;
  const DeviceLighting& lighting;
  View<Splat> points;         ///< of the pool
  bool by_paths = false;      ///< a path tracer makes the picture
  bool quiet = false;         ///< no progress
  std::function<bool()> stop; ///< asked before every launch
};

/// Runs `vmap` and `fmm` where the scene needs them, and says of each stage that does not run why. Throws Error(input)
/// for what this version does not have, Error(interrupted) when `stop` says so.
IndirectLight run_indirect_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                  StageLog& stages);

/// Why vmap and fmm do not run, in a few words; empty when they do: the scene has light, and surfaces that send each
/// other some of it.
std::string reason_against_radiosity(const IndirectRequest& request);

/// Refuses settings of [radiosity] that this version does not have, before the work. Throws Error(input).
void require_known_radiosity(const Scene& scene);

} // namespace pointgi
