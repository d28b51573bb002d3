#pragma once
/// Points spread evenly over triangles.
#include "host/cloud/point_cloud.h"
#include <array>
#include <string>
#include <vector>

namespace pointgi {

/// One triangle with what its corners carry. Its winding tells the outside.
struct MeshTriangle {
  std::array<Eigen::Vector3d, 3> position; ///< world units
  std::array<Eigen::Vector3f, 3> normal;   ///< zero where the mesh has none
  std::array<Eigen::Vector3f, 3> colour;   ///< [0,1]
};

/// About `wanted` points (1 ... 1e8) on the triangles, no two on one side of a sheet closer than 0.78 of the mean
/// spacing sqrt(area / wanted). Fills position, normal, area, clipped (where faces
/// end within two spacings), and colour if `with_colour`. Deterministic. Requires a
/// finite total area > 0; triangles whose own area is not finite and > 0 get no points.
PointCloud sample_triangles(const std::vector<MeshTriangle>& triangles, double wanted, bool with_colour);

/// The triangle's area, or 0 where it is not finite. [world units squared]
double usable_area(const MeshTriangle& triangle);

/// Sum of the triangles' usable areas. [world units squared]
double total_area(const std::vector<MeshTriangle>& triangles);

} // namespace pointgi
