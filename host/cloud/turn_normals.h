#pragma once
/// Turns the normals of a whole cloud round.
#include "host/cloud/knn.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// All normals, and the winding of all faces if it went with them.
void turn_round(PointCloud& cloud);

/// Turns them where the surface is closed and they point inwards as a whole, and warns of it. Areas must be known.
void turn_inside_out_if_inward(PointCloud& cloud, const Sites& sites, CloudReport& report);

/// Whether the scene's camera or a lamp is among the points: then normals that face inwards are meant so.
bool is_seen_from_inside(const PointCloud& cloud, const std::vector<Eigen::Vector3d>& eyes);

} // namespace pointgi
