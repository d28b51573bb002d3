#pragma once
/// How far apart the sites of a cloud are, and whether neighbours face the same way.
#include "host/cloud/knn.h"

namespace pointgi {

/// Radius of a splat over the covering radius of its cell.
constexpr double splat_overlap = 1.2;

/// Normals whose cosine is below oppose each other.
constexpr double opposite_cosine = -0.3;

/// Neighbours that a spacing is taken from.
constexpr unsigned spacing_neighbours = 6;

/// The side of a square that holds one site where its `count` > 0 nearest lie as `near` says; local units.
float spacing_of(const Neighbour* near, unsigned count);

/// A value a site, local units, > 0: the side of a square that holds one point. A lone site has one that makes its
/// splats' radius 1.
std::vector<float> spacings_of(const Sites& sites);

/// The same, and sites.keep_neighbours(k) in one go; k >= spacing_neighbours.
std::vector<float> keep_neighbours_and_spacings(Sites& sites, unsigned k);

/// Sites far out of proportion with their neighbours (isolated ones) get those neighbours' spacing.
void rein_in_isolated(const Sites& sites, std::vector<float>& spacing);

struct SiteSpacing {
  std::vector<float> spacing;          ///< a value a site, as spacings_of() and rein_in_isolated() give them
  std::vector<Eigen::Vector3f> normal; ///< of the first point at each site: beside its neighbours' in memory, too
  double opposite = 0; ///< share, 0 .. 1, of neighbours side by side on the surface whose normals oppose each other
};

/// `normals`: unit, a value a point; `spacing`: becomes the result's. Of more than a million sites `opposite` is that
/// of a sample.
SiteSpacing with_normals(const Sites& sites, const std::vector<Eigen::Vector3f>& normals, std::vector<float>&& spacing);

} // namespace pointgi
