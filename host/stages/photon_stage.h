#pragma once
/// The stage `photon`: which scenes need it, and what it found.
#include "host/photon/trace_photons.h"
#include "host/stages/indirect_stages.h"

namespace pointgi {

struct Caustics {
  std::vector<Photon> photons;        ///< stored on diffuse surfaces
  std::optional<PhotonLedger> ledger; ///< absent: the stage did not run
  double from_surfaces = 0.0; ///< photons of a flight from surfaces that sends all of their light; 0: not known yet
};

/// Sends photons where the scene has specular splats, light and caustics.photons > 0, and says why not where it does
/// not. `normal_field`: of the specular splats; null: there are none. Throws Error(interrupted) when the run
/// (host/run.h) is to stop.
Caustics run_photon_stage(Session& session, const DevicePools& pools, const IndirectRequest& request,
                          const Buffer<cl_float4>* normal_field, StageLog& stages);

/// The stage once more: `share` of caustics.photons, all at most, from the diffuse surfaces, by their radiosity [points
/// x 3, as IndirectLight] (LD+S+D), are added to those that are there. Only after a run_photon_stage that sent some;
/// throws as it does. Returns the irradiance [points x 3] that they bring.
std::vector<float> add_indirect_photons(Session& session, const DevicePools& pools, const IndirectRequest& request,
                                        const Buffer<cl_float4>& normal_field, View<float> radiosity, double share,
                                        std::uint32_t flight, Caustics& caustics, StageLog& stages);

/// The end of the stage: the photons as the picture gathers them, and what they bring to the points; absent where none
/// was stored.
std::optional<DevicePhotonMap> upload_caustics(Session& session, const Caustics& caustics,
                                               const IndirectRequest& request, StageLog& stages);

} // namespace pointgi
