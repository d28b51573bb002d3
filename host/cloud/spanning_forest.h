#pragma once
/// Agreement of normals between neighbours, carried along a minimum spanning forest.
#include "host/cloud/knn.h"

namespace pointgi {

struct SpanningForest {
  std::vector<std::uint32_t> tree; ///< site -> number of its tree, 0 .. trees-1 in order of their first sites
  std::uint32_t trees = 0;
  std::vector<float> spacing2; ///< site -> estimate of the area a site stands for, local units squared
};

/// How well the signs of two unit normals go together, -1 .. 1, when their sites lie at offset e from one another: one
/// normal is mirrored at the plane half-way and compared with the other. Exact on planes, spheres, folds of any angle
/// and across thin sheets, where the plain product of the normals says nothing or the wrong thing.
inline double sign_agreement(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& e) {
  const double d2 = e.squaredNorm();
  return d2 > 0 ? a.dot(b) - 2.0 * a.dot(e) * b.dot(e) / d2 : a.dot(b);
}

/// Flips normals so that they agree along the edges of a minimum spanning forest of the 8-nearest-neighbour graph, the
/// surest edges first. What remains free is one sign a tree. Deterministic. Edges, eight slots a site, are numbered by
/// 32 bits where there are at most `narrow_slots`, by 64 where there are more: the result is the same.
SpanningForest agree_normals(const Sites& sites, std::vector<Eigen::Vector3f>& normals,
                             std::uint64_t narrow_slots = std::uint64_t{1} << 32);

} // namespace pointgi
