#include "fmm/operators/cluster_flux.h"
#include "octree/parallel.h"
#include <array>
#include <cmath>

namespace pointgi {

namespace {

/// Normals within this angle of their mean, radians, have one flux: of what faces away where others face a receiver
/// little is left, and little is lost when it cancels.
constexpr float one_flux_cone = 0.7f;

constexpr std::size_t side_count = 6;

/// The side that a normal faces most.
template <typename Normal>
std::size_t side_of(const Normal& n) {
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::fabs(n[a]) > std::fabs(n[axis])) axis = a;
  return 2 * axis + (n[axis] < 0 ? 1 : 0);
}

/// First moments of the power, and of the area with the normals, which tell where a dark cluster would shine.
struct Sums {
  Eigen::Vector3d flux[3], moment{0, 0, 0}, normal{0, 0, 0};
  double power = 0.0;

  Sums() {
    for (auto& colour : flux)
      colour.setZero();
  }
  void add(const ExchangePoint& p, const double* b) {
    for (int c = 0; c < 3; ++c)
      flux[c] += p.area * b[c] * p.n;
    const double w = p.area * (b[0] + b[1] + b[2]);
    moment += w * p.x;
    power += w;
    normal += p.area * p.n;
  }
  void add(const Sums& child) {
    for (int c = 0; c < 3; ++c)
      flux[c] += child.flux[c];
    moment += child.moment;
    power += child.power;
    normal += child.normal;
  }
};

using SumsOfSides = std::array<Sums, side_count>;

Sums sums_of(const SumsOfSides& sides, std::uint8_t side) {
  if (side != all_sides) return sides[side];
  Sums all;
  for (const Sums& one : sides)
    all.add(one);
  return all;
}

bool is_leaf(const Cluster& cluster) {
  return cluster.child_count == 0;
}

} // namespace

FluxSides flux_sides(const ClusterTree& tree) {
  const std::size_t clusters = tree.nodes.size();
  std::vector<std::uint8_t> faced(clusters, 0); // a bit a side
  for (std::size_t k = clusters; k-- > 0;) {
    const Cluster& cluster = tree.nodes[k];
    if (is_leaf(cluster))
      for (std::uint32_t j = cluster.first_point; j < cluster.first_point + cluster.count; ++j)
        faced[k] = static_cast<std::uint8_t>(faced[k] | 1u << side_of(tree.points[j].normal));
    if (k != 0) faced[cluster.parent] = static_cast<std::uint8_t>(faced[cluster.parent] | faced[k]);
  }
  FluxSides sides;
  for (std::size_t k = 0; k < clusters; ++k) {
    sides.begin.push_back(static_cast<std::uint32_t>(sides.side.size()));
    if (tree.nodes[k].cone <= one_flux_cone) {
      sides.side.push_back(all_sides);
      continue;
    }
    for (std::size_t side = 0; side < side_count; ++side)
      if ((faced[k] >> side & 1u) != 0) sides.side.push_back(static_cast<std::uint8_t>(side));
  }
  sides.begin.push_back(static_cast<std::uint32_t>(sides.side.size()));
  return sides;
}

void update_cluster_fluxes(const ClusterTree& tree, const FluxSides& sides, View<ExchangePoint> points,
                           View<double> radiosity, Judge judge, std::vector<ClusterFlux>& fluxes) {
  const std::size_t clusters = tree.nodes.size();
  std::vector<SumsOfSides> sums(clusters);
  parallel_ranges(clusters, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Cluster& cluster = tree.nodes[k];
      if (is_leaf(cluster))
        for (std::uint32_t j = cluster.first_point; j < cluster.first_point + cluster.count; ++j)
          sums[k][side_of(points[j].n)].add(points[j], radiosity.data + 3 * static_cast<std::size_t>(j));
    }
  });
  for (std::size_t k = clusters; k-- > 1;)
    for (std::size_t side = 0; side < side_count; ++side)
      sums[tree.nodes[k].parent][side].add(sums[k][side]);
  fluxes.resize(sides.side.size());
  for (std::size_t k = 0; k < clusters; ++k)
    for (std::uint32_t at = sides.begin[k]; at < sides.begin[k + 1]; ++at) {
      ClusterFlux& f = fluxes[at];
      const Sums sum = sums_of(sums[k], sides.side[at]);
      std::copy_n(sum.flux, 3, f.flux);
      f.power = sum.power;
      if (judge == Judge::before) continue;
      const float* middle = tree.nodes[k].centre;
      f.centre =
          f.power > 0.0 ? Eigen::Vector3d(sum.moment / f.power) : Eigen::Vector3d(middle[0], middle[1], middle[2]);
      for (int c = 0; c < 3; ++c)
        f.judge[c] = f.flux[c].squaredNorm() > 0.0 ? f.flux[c] : sum.normal;
    }
}

} // namespace pointgi
