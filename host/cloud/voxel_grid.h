#pragma once
#include <Eigen/Core>
#include <vector>

namespace pointgi {

/// Which points stand for the cubes that hold them: of each cube of a grid of this edge through the origin the point
/// nearest to its middle, of equal ones the first. A point that is not finite lies in no cube. `edge` > 0. O(n), by a
/// table of 8 to 16 bytes a cube.
std::vector<bool> one_point_a_voxel(const std::vector<Eigen::Vector3d>& positions, double edge);

} // namespace pointgi
