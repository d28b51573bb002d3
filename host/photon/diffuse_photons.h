#pragma once
/// Photons and the light that diffuse surfaces exchange: each can be the other's source (method.md §1, the paths that
/// are off by default).
#include "host/photon/emission_plan.h"
#include "shared/photon_types.h"

namespace pointgi {

/// Irradiance [points x 3, W/m², scaled] that the photons bring to the splats they were stored on: their power over the
/// splat's effective area. All of their power is in it, whatever they make of a place between splats.
std::vector<float> irradiance_by_photons(View<Photon> photons, View<Splat> points);

/// Splats of radiosity [points x 3, W/m², scaled] > 0 as sources of photons: an area light each, of radiance B/pi.
PhotonSources sources_of_radiosity(View<float> radiosity, View<Splat> points);

} // namespace pointgi
