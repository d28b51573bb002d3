#pragma once
#include "host/cloud/point_cloud.h"
#include <functional>

namespace pointgi {

/// Removes the points that `wanted(index)` does not want, from every attribute; what is left keeps its order, and
/// `record` still says which points of the file these are. Triangles are renumbered; those that refer to a removed
/// point, or to none, go too. `wanted` is asked once for each point, in order. Returns how many points went.
std::size_t keep_points(PointCloud& cloud, const std::function<bool(std::size_t)>& wanted);

} // namespace pointgi
