#pragma once
/// Directions over the hemisphere of a point in which it looks for light (method.md section 8).
#include <array>
#include <vector>

namespace pointgi {

enum class DirectionPattern {
  stratified, ///< one place drawn in each of n cells of equal cosine-weighted solid angle
  hemicube    ///< through the middles of the cells of a hemicube (Cohen and Greenberg, 1985)
};

struct DirectionSet {
  DirectionPattern pattern;
  /// A direction each. Stratified: first u, width in u, first v, width in v, of cosine_direction
  /// (kernels/lib/sampling.cl): rings of the disc below the hemisphere, and sectors of them. Hemicube: x, y, z about
  /// the normal z, unit.
  std::vector<std::array<float, 4>> cells;
  std::vector<float> weights; ///< form factor of each cell; they sum to 1
};

/// About `count` directions, 1 or more: stratified exactly so many; of a hemicube, whose top has an even number m of
/// cells a side and whose four sides m x m/2, those of the m that comes nearest.
DirectionSet direction_set(DirectionPattern pattern, unsigned count);

} // namespace pointgi
