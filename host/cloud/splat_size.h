#pragma once
/// Effective areas and splat radii of a cloud with normals: both from one Voronoi cell a point.
#include "host/cloud/knn.h"

namespace pointgi {

/// How far apart sites are and whether neighbours face the same way.
struct SiteSpacing {
  std::vector<float> spacing;          ///< a value a site, local units: the side of a square that holds one point; > 0
  std::vector<Eigen::Vector3f> normal; ///< of the first point at each site: beside its neighbours' in memory, too
  double opposite = 0; ///< share, 0 .. 1, of neighbours side by side on the surface whose normals oppose each other
};

/// `normals`: unit, a value a point; empty: `opposite` is not looked for. Sites far out of proportion with their
/// neighbours (isolated ones) get those neighbours' spacing, if `reined_in`. A lone site has one that makes its splats'
/// radius 1.
SiteSpacing site_spacing(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, bool reined_in = true);

struct SplatSizes {
  std::vector<float> radius; ///< a value a point, world units, > 0
  std::vector<float> area;   ///< a value a point, world units squared, > 0
  std::size_t capped = 0;    ///< points whose cell no neighbour bounds on some side, so that the spacing there does
};

/// The cells (method.md §4: the sum of the areas is that of the surface). Each point's neighbours are laid flat into
/// its tangent plane (unfold.h); its cell there is what is nearer to it than to any of them; its area is the cell's,
/// its radius covers the cell with `overlap` to spare, as blending weights fall to 0 at the rim of a splat. Boundaries
/// of open surfaces are closed half a spacing outside the last points. Points at one site that face alike share a cell.
/// `noisy`: where neighbours' normals differ without being a crease, discs are widened for the gaps that tilt leaves.
/// `faces_agree`: normals have consistent signs, so that opposite ones tell the two sides of a thin sheet apart.
SplatSizes splat_sizes(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, const SiteSpacing& spacing,
                       bool faces_agree, bool noisy);

/// Radius over covering radius of the cell.
constexpr double splat_overlap = 1.2;

} // namespace pointgi
