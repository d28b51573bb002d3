#pragma once
#include "host/scene/splats.h"

namespace pointgi {

/// Chooses a camera that shows the splats well: what faces outward is looked at from outside, an open scan from the
/// side that was scanned, a depth image from its sensor, terrain from above; the splats fill the frame.
/// Returns a sentence that says what was chosen.
std::string choose_camera(Scene& scene, const WorldSplats& splats);

/// A key light over the viewer's left shoulder and a dim sky; white that faces the light comes out at about 0.8.
void choose_lights(Scene& scene);

} // namespace pointgi
