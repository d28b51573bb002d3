#pragma once
/// Photons and the light that diffuse surfaces exchange: each can be the other's source (method.md §1, the paths that
/// are off by default).
#include "host/photon/emission_plan.h"
#include "shared/photon_types.h"

namespace pointgi {

/// Irradiance [points x 3, W/m², scaled] that the photons bring to the splats they were stored on: their power over the
/// splat's effective area. All of their power is in it, whatever they make of a place between splats.
std::vector<float> irradiance_by_photons(View<Photon> photons, View<Splat> points);

/// What kernels/photon/emit_from_surfaces.cl starts from: for emitters the splats of which passed_on(splat) is above 0,
/// by that times their areas: about what goes on by them; for radiance B/pi of all points, of radiosity B [points x 3,
/// W/m², scaled]. No emitters where all are dark.
PhotonSources sources_of_radiosity(View<float> radiosity, View<Splat> points,
                                   const std::function<double(const Splat&)>& passed_on);

} // namespace pointgi
