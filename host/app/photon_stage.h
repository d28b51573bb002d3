#pragma once
/// The stage `photon`: which scenes need it, and what it found.
#include "host/app/indirect_stages.h"
#include "host/passes/photon.h"

namespace pointgi {

struct Caustics {
  std::optional<DevicePhotonMap> map; ///< absent: no photon was stored
  std::optional<PhotonLedger> ledger; ///< absent: the stage did not run
};

/// Sends photons where the scene has specular splats, light and caustics.photons > 0, and says why not where it does
/// not. `normal_field`: of the specular splats; null: there are none. Throws Error(memory) for too many photons,
/// Error(interrupted) when request.stop says so.
Caustics run_photon_stage(Session& session, const DevicePools& pools, const IndirectRequest& request,
                          const Buffer<cl_float4>* normal_field, StageLog& stages);

} // namespace pointgi
