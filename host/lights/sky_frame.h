#pragma once
/// Directions of the sky in a scene.
#include "host/scene/scene.h"

namespace pointgi {

/// Orthonormal: `forward` is azimuth 0, `right` azimuth 90 degrees, clockwise as seen from above.
struct SkyFrame {
  Vector3d right, forward, up;
};

/// Before it is turned, forward is +y and right +x where z is up, and -z and +x where y is: as a camera looks that
/// looks north on a map. Right is +x also where -y or -z is up, and +y where x or -x is. Turned by `turn_deg` clockwise
/// as seen from above.
SkyFrame sky_frame(UpAxis up, double turn_deg);

/// Unit vector.
Vector3d sky_direction(const SkyFrame& frame, double azimuth_deg, double elevation_deg);

} // namespace pointgi
