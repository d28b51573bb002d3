#pragma once
/// What kind of scene it is, as far as the choice of settings goes: presets are measured on scenes of each kind
/// (host/scene/presets.h).
#include "host/stages/prepared_scene.h"

namespace pointgi {

/// "glass and mirror", "foliage", "terrain", "interior" (scanned), "room" (the camera is inside), or "statue".
std::string kind_of_scene(const Scene& scene, const PreparedScene& ready);

} // namespace pointgi
