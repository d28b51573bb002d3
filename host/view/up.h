#pragma once
/// Which way is up, where neither the user nor the file says.
#include "host/view/view_points.h"

namespace pointgi {

struct UpChoice {
  Vector3d up; ///< plus or minus an axis
  std::string reason;
};

/// `eye`: where the points were seen from, for a depth frame. Scans of stations and maps: z, against which gravity
/// pulls. Terrain: its thin axis, on the side that it faces. Rooms: whichever of z and y more surface is
/// across. Depth frames: whichever way more of the surface faces, floors and tables. Sparse points: whichever way more
/// of them lie in a level layer at the bottom. Models and foliage: what they stand on, else the axis that they are
/// symmetric about, else y. `usual`: what the file's format is used to, CloudReport::usual_up: sparse points have it,
/// and models and foliage that do not stand on a broad flat foot.
UpChoice find_up(const ViewPoints& points, CloudKind kind, const Vector3d& eye,
                 const std::optional<Vector3d>& usual = {});

} // namespace pointgi
