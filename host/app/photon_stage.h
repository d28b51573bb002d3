#pragma once
/// The stage `photon`: which scenes need it, and what it found.
#include "host/app/stages.h"
#include "host/passes/photon.h"
#include "host/scene/frame.h"

namespace pointgi {

struct Caustics {
  std::optional<DevicePhotonMap> map; ///< absent: no photon was stored
  std::optional<PhotonLedger> ledger; ///< absent: the stage did not run
};

/// Sends photons where the scene has specular splats, light and caustics.photons > 0, and says why not where it does
/// not. `normal_field`: of the specular splats; null: there are none. `by_paths`: a path tracer makes the picture,
/// which needs no photons. Throws Error(memory) for too many photons, Error(interrupted) when `stop` says so.
Caustics run_photon_stage(Session& session, const DevicePools& pools, const TraversalVariant& variant,
                          const Scene& scene, const Frame& frame, const DeviceLighting& lighting, View<Splat> points,
                          const Buffer<cl_float4>* normal_field, bool by_paths, StageLog& stages,
                          const std::function<bool()>& stop);

} // namespace pointgi
