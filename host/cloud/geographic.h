#pragma once
/// Longitude and latitude in degrees beside heights in metres: such a cloud is a needle until its degrees are lengths.
#include "host/cloud/point_cloud.h"
#include <optional>

namespace pointgi {

/// Where the points of degrees are put, in metres, when there is reason to see degrees in x and y: `declared` by the
/// file and within the range of longitude and latitude; or else that range and an extent in z of more than 300 times
/// that in x and y, which no scanned thing has. Nothing otherwise. Points that are not finite are left out.
/// [WGS 84's radii of curvature at the cloud's middle]
std::optional<Placement> degrees_to_metres(const std::vector<Eigen::Vector3d>& positions, bool declared);

} // namespace pointgi
