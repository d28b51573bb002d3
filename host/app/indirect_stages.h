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
};

/// Runs `vmap` and `fmm` where the scene asks for radiosity ([radiosity]) and has light, and says of each stage that
/// does not run why. `by_paths`: a path tracer makes the picture, which needs neither. Throws Error(input) for what
/// this version does not have, Error(interrupted) when `stop` says so.
IndirectLight run_indirect_stages(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                                  const Scene& scene, const Frame& frame, const DeviceLighting& lighting,
                                  View<Splat> points, bool by_paths, StageLog& stages,
                                  const std::function<bool()>& stop);

/// The normal field of the specular and glossy splats, as the device takes it (kernels/lib/pools.cl): the stage
/// `normals`; absent where there are none, and the stage is skipped.
std::optional<Buffer<cl_float4>> normal_field_of(Session& session, const DeviceLighting& lighting, View<Splat> points,
                                                 StageLog& stages);

/// Refuses settings of [radiosity] that this version does not have, before the work. Throws Error(input).
void require_known_radiosity(const Scene& scene);

} // namespace pointgi
