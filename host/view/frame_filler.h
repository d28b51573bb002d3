#pragma once
/// Cameras that show all there is, and little else.
#include "host/scene/scene.h"
#include "host/view/view_points.h"

namespace pointgi {

/// A camera of the scene's size and angle of view, in the direction `from` of what it looks at, as near as the points'
/// bounds allow. Where backs are seen through, what faces away does not count.
void fill_frame(Scene& scene, const ViewPoints& points, const Vector3d& from, const Vector3d& up, Backfaces backfaces);

/// A camera at `eye` that turns to the points and takes an angle of view for all in front of it, 120 degrees at most.
void look_from(Scene& scene, const ViewPoints& points, const Vector3d& eye, const Vector3d& up);

} // namespace pointgi
