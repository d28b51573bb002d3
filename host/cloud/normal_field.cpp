#include "host/cloud/normal_field.h"
#include "host/cloud/knn.h"
#include "octree/parallel.h"
#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace pointgi {

namespace {

/// Two rings around a splat, by which noise of single normals is evened out; the second counts little.
constexpr unsigned field_neighbours = 18;
/// As discs that are blended (kernels/surface/blend.cl).
constexpr float same_surface_cosine = 0.5f;
/// Of the larger spread of the neighbours along some axis: neighbours that stand nearly in a line tell nothing of what
/// is across it.
constexpr double across_a_line = 1e-3;

Eigen::Vector3d vector(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// The fit of one splat. `other(i)`: its i-th neighbour, or null; the last one has no weight (host/cloud/normals.cpp).
template <typename Other>
NormalSlopes fit(const Splat& splat, const Neighbour* neighbours, unsigned count, const Other& other) {
  float a_of[3], b_of[3];
  splat_tangents(splat.normal, a_of, b_of);
  const Eigen::Vector3d n = vector(splat.normal), a = vector(a_of), b = vector(b_of);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero(), changes = Eigen::Matrix2d::Zero();
  const double reach2 = count > 0 ? double{neighbours[count - 1].distance2} : 0.0;
  for (unsigned i = 0; i < count && reach2 > 0.0; ++i) {
    const Splat* neighbour = other(i);
    if (neighbour == nullptr) continue;
    const Eigen::Vector3d to = vector(neighbour->position) - vector(splat.position), m = vector(neighbour->normal);
    if (material_of(*neighbour) != material_of(splat) || m.dot(n) <= same_surface_cosine) continue;
    const double weight = 1.0 - double{neighbours[i].distance2} / reach2;
    const Eigen::Vector2d at(to.dot(a), to.dot(b)), change(m.dot(a), m.dot(b));
    moments += weight * at * at.transpose();
    changes += weight * at * change.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moments);
  NormalSlopes result;
  const double large = axes.eigenvalues()[1];
  if (!(large > 0.0)) return result;
  Eigen::Matrix2d slopes = Eigen::Matrix2d::Zero(); // row: along a, along b; column: of the normal's a, b
  for (int k = 0; k < 2; ++k)
    if (axes.eigenvalues()[k] > across_a_line * large)
      slopes += axes.eigenvectors().col(k) * (axes.eigenvectors().col(k).transpose() * changes) / axes.eigenvalues()[k];
  for (int k = 0; k < 4; ++k)
    result.slope[k] = static_cast<float>(slopes(k / 2, k % 2));
  return result;
}

} // namespace

void splat_tangents(const float n[3], float a[3], float b[3]) {
  const float s = std::copysign(1.0f, n[2]), c = -1.0f / (s + n[2]), d = n[0] * n[1] * c;
  a[0] = 1.0f + s * n[0] * n[0] * c, a[1] = s * d, a[2] = -s * n[0];
  b[0] = d, b[1] = s + n[1] * n[1] * c, b[2] = -n[1];
}

std::vector<NormalSlopes> fit_normal_field(View<Splat> splats, const std::function<bool(const Splat&)>& wanted) {
  std::vector<NormalSlopes> field(splats.size);
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::size_t> of; // splat of each position
  for (std::size_t i = 0; i < splats.size; ++i)
    if (wanted(splats[i])) {
      positions.push_back(vector(splats[i].position));
      of.push_back(i);
    }
  if (positions.empty()) return field;
  const Sites sites(positions);
  parallel_ranges(sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, field_neighbours> neighbours;
    for (std::size_t site = begin; site < end; ++site) {
      const unsigned count = sites.nearest(static_cast<std::uint32_t>(site), field_neighbours, neighbours.data());
      for (const std::uint32_t point : sites.points(static_cast<std::uint32_t>(site))) {
        const Splat& splat = splats[of[point]];
        field[of[point]] = fit(splat, neighbours.data(), count, [&](unsigned i) -> const Splat* {
          // Of several in one place, as of a sheet's two sides, the one that faces this way.
          const Splat* best = nullptr;
          float most = -2.0f;
          for (const std::uint32_t other : sites.points(neighbours[i].site)) {
            const Splat& candidate = splats[of[other]];
            const auto cosine = static_cast<float>(vector(candidate.normal).dot(vector(splat.normal)));
            if (material_of(candidate) == material_of(splat) && cosine > most) best = &candidate, most = cosine;
          }
          return best;
        });
      }
    }
  });
  return field;
}

} // namespace pointgi
