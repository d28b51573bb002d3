#pragma once
/// Normals where a file has none: from its faces, or from how the neighbours lie.
#include "host/cloud/knn.h"
#include "host/cloud/point_cloud.h"

namespace pointgi {

/// Unit normal of the plane through the neighbours of a site (weighted PCA over the 18 nearest; 72 where those lie on a
/// line, as along a scan line; up to 144 where noise hides the surface, method.md §4). The sign is arbitrary. A lone
/// site gets +z, sites on a line some direction across it.
Eigen::Vector3f estimate_normal(const Sites& sites, std::uint32_t site);

/// estimate_normal() of every site; beside edges, where that plane cuts the corner, the normal of a flatter neighbour
/// whose plane the site lies on; where there is noise, averaged with the neighbours'. `structure`, if not null: of each
/// site, by the variances of its neighbourhood (Demantké et al. 2011); strays are not looked for.
std::vector<Eigen::Vector3f> estimate_normals(const Sites& sites, std::vector<Structure>* structure = nullptr);

/// Unit vertex normals, a value a point: the sum of the normals of its faces (by their winding: counter-clockwise seen
/// from outside) weighted by the face's angle there, so that they do not depend on how a polygon was cut into
/// triangles. Zero for points in no face of positive area. Faces with indices out of range are ignored.
std::vector<Eigen::Vector3f> face_normals(const PointCloud& cloud);

/// Gives points whose normal is zero an estimated one, turned to agree with the nearest points that have theirs.
/// `normals`: a value a point of the cloud that `sites` was made from. Returns how many were filled in.
std::size_t fill_missing_normals(const PointCloud& cloud, const Sites& sites, std::vector<Eigen::Vector3f>& normals);

} // namespace pointgi
