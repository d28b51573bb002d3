#pragma once
/// A level plane under what stands free, for the shadow it casts.
#include "host/scene/scene.h"
#include "host/view/view_points.h"

namespace pointgi {

/// Whether the points have a ground of their own: a level surface below that is about as wide as all of them.
bool has_ground(const ViewPoints& points, const Vector3d& up);

/// A disc under the points, level with `up`, four times as wide as they are, of splats that are small below them and
/// grow outwards: some five thousand in all. Complete (complete_cloud()); without colours.
PointCloud ground_under(const ViewPoints& points, const Vector3d& up);

} // namespace pointgi
