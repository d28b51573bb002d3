#pragma once
/// Light that makes form readable, where there is none.
#include "host/view/default_view.h"

namespace pointgi {

/// Sun and sky around a bare cloud, lamps inside a closed room. At exposure 0 what is white and faces the light comes
/// out at about 0.8. Where the scene wants a ground and the splats stand free, adds one to both, with a material of its
/// own that comes out as bright as the background, so that its rim does not show. The background is lighter than the
/// splats. Returns sentences of what was chosen, for the log.
std::vector<std::string> choose_lights(Scene& scene, WorldSplats& splats, const ChosenView& view);

/// A ground under a scene that has its own lights.
void add_ground(Scene& scene, WorldSplats& splats, const ChosenView& view, const Vector3d& albedo);

} // namespace pointgi
