#pragma once
/// All stages of light between the octree and the picture, in the order that the scene asks for.
#include "host/stages/photon_stage.h"

namespace pointgi {

struct SceneLight {
  IndirectLight indirect;
  std::optional<StoredDirect> direct;            ///< absent: shadow rays find all direct light
  std::optional<Buffer<cl_float4>> normal_field; ///< absent: nothing is specular
  std::optional<DevicePhotonMap> photons;        ///< absent: none was stored
  std::optional<PhotonLedger> ledger;            ///< absent: none was sent
};

/// `shafts`, `vmap`, that of the radiosity method, `normals`, `photon`; with caustics.feedback `normals` and `photon`
/// first, as diffuse surfaces then pass on what the photons bring; with caustics.indirect `photon` once more at the
/// end, from these surfaces; with both, the method and `photon` in turn for what these photons bring, until they bring
/// next to nothing. Throws what the stages throw.
SceneLight run_light_stages(Session& session, const DevicePools& pools, const IndirectRequest& request,
                            StageLog& stages);

} // namespace pointgi
