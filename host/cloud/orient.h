#pragma once
/// Which side of the surface estimated normals are on.
#include "host/cloud/knn.h"
#include <optional>
#include <string>

namespace pointgi {

/// Turns unit normals of arbitrary sign, a value a site, to one side of the surface. Returns how that was decided, as
/// shown to the user: "towards the viewpoint", "towards the sensor at the origin", "outwards", "upwards along z", ...
///
/// A sensor (`viewpoint`, world units; or the origin, where the cloud is a depth image seen from there) saw every
/// point, so each normal is turned towards it. Otherwise neighbours are made to agree along a minimum spanning forest
/// (Hoppe et al. 1992), and each tree is turned as a whole: closed surfaces outwards, open flat ones (airborne lidar)
/// upwards along the axis in which they are thinnest, small fragments like the nearest larger piece.
std::string orient_normals(const Sites& sites, const std::optional<Eigen::Vector3d>& viewpoint,
                           std::vector<Eigen::Vector3f>& normals);

/// Share of sites, 0 to 1, whose nearest neighbour as seen from `sensor` (local units) is near in space too. About 1
/// for what a depth camera at `sensor` records, about 1/2 where a front and a back lie behind one another. 0 when the
/// sensor is inside the cloud, or so far off (over ten times its size) that nobody would have scanned it from there.
double depth_image_share(const Sites& sites, const Eigen::Vector3d& sensor);

} // namespace pointgi
