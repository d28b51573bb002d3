#pragma once
/// Where discs of scans and meshes end before their rims do: at edges, and where they would stick out of a bent
/// surface.
#include "host/cloud/point_cloud.h"
#include "host/cloud/site_spacing.h"
#include <limits>
#include <optional>

namespace pointgi {

/// What is known of a cloud whose discs are to end.
struct BorderEvidence {
  std::vector<ClippedPoint> rims; ///< boundaries of open surfaces (SplatSizes); of a mesh, its edges and boundaries
  bool from_faces = false;        ///< rims are a mesh's own: exact, and all that there are
  bool normals_given = false;     ///< and are not to be doubted
  bool areas_given = false;       ///< by a sampler: they stay
  /// Cosine of normals above which splats follow a bent surface to a neighbour, as patches do; discs do nowhere.
  double followed_cosine = std::numeric_limits<double>::infinity();
  std::optional<Eigen::Vector3d> sensor; ///< of a scan from one place: surfaces face it
};

/// Fills cloud.clipped for points of surfaces. A disc ends
///   - at its rims;
///   - of a scan, at an edge that sticks out, where the two faces' planes meet: the other's plane is a mean over its
///     points;
///   - of a surface bent outwards, to neighbours that it does not follow, at the bounds of its cell, where it would
///   stick out of its neighbours' planes.
/// Points nearer to an edge than a tenth of their radius, or past it, move that far inside along their face.
/// Discs beside an edge grow where they must, to reach it; their areas become those of their cells on their own face.
/// Requires normals with their final sides, radii and areas. Sites of more than 16 points are left as they are.
void clip_discs(PointCloud& cloud, const Sites& sites, const SiteSpacing& spacing, BorderEvidence&& evidence);

} // namespace pointgi
