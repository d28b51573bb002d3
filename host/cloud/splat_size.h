#pragma once
/// Effective areas and splat radii of a cloud with normals: both from one Voronoi cell a point.
#include "host/cloud/point_cloud.h"
#include "host/cloud/site_spacing.h"

namespace pointgi {

struct SplatSizes {
  std::vector<float> radius;      ///< a value a point, world units, > 0
  std::vector<float> area;        ///< a value a point, world units squared, > 0
  std::vector<ClippedPoint> rims; ///< points at the boundary of an open surface, in any order, and where it ends
  std::size_t capped = 0; ///< points whose cell no neighbour bounds on some side, so that the spacing there does
};

/// The cells (method.md §4: the sum of the areas is that of the surface). Each point's neighbours are laid flat into
/// its tangent plane (unfold.h); its cell there is what is nearer to it than to any of them; its area is the cell's,
/// its radius covers the cell with `overlap` to spare, as blending weights fall to 0 at the rim of a splat. Boundaries
/// of open surfaces are closed half a spacing outside the last points. Points at one site that face alike share a cell.
/// `noisy`: where neighbours' normals differ without being a crease, discs are widened for the gaps that tilt leaves.
/// `faces_agree`: normals have consistent signs, so that opposite ones tell the two sides of a thin sheet apart.
SplatSizes splat_sizes(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const SiteSpacing& spacing,
                       bool faces_agree, bool noisy);

/// As near to the value as a float comes that is positive and finite.
float positive_float(double value);

} // namespace pointgi
