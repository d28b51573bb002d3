#pragma once
/// Lamps for rooms that have none.
#include "host/view/default_view.h"

namespace pointgi {

/// Puts lamps below the ceiling: at the stations where these are known, else one for each part of the plan that is
/// about as wide as the room is high, where there is floor below and ceiling above; ten at most. The background is a
/// light grey of the lit room's brightness. Returns their number.
std::size_t light_room(Scene& scene, const WorldSplats& splats, const ChosenView& view);

} // namespace pointgi
