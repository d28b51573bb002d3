#include "fmm/operators/cluster_flux.h"
#include "octree/parallel.h"
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

/// First moments of the power, and of the area with the normals, which tell where a dark side would shine.
struct Sums {
  Eigen::Vector3d flux[3], moment{0, 0, 0}, normal{0, 0, 0}, area_moment{0, 0, 0};
  double power = 0.0, area = 0.0;

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
    area_moment += p.area * p.x;
    area += p.area;
  }
  void add(const Sums& child) {
    for (int c = 0; c < 3; ++c)
      flux[c] += child.flux[c];
    moment += child.moment;
    power += child.power;
    normal += child.normal;
    area_moment += child.area_moment;
    area += child.area;
  }
  Eigen::Vector3d centre() const {
    if (power > 0.0) return moment / power;
    return area > 0.0 ? Eigen::Vector3d(area_moment / area) : area_moment;
  }
};

bool has_one_flux(const Cluster& cluster) {
  return cluster.cone <= one_flux_cone;
}

bool is_leaf(const Cluster& cluster) {
  return cluster.child_count == 0;
}

std::uint8_t bit_of(std::size_t side) {
  return static_cast<std::uint8_t>(1u << side);
}

/// Of each cluster that has no single flux, a bit for each side that its points, or the whole of such a child, face.
std::vector<std::uint8_t> faced_sides(const ClusterTree& tree) {
  std::vector<std::uint8_t> faced(tree.nodes.size(), 0);
  for (std::size_t k = tree.nodes.size(); k-- > 0;) {
    const Cluster& cluster = tree.nodes[k];
    if (has_one_flux(cluster)) {
      faced[k] = bit_of(side_of(cluster.axis));
    } else if (is_leaf(cluster)) {
      for (std::uint32_t j = cluster.first_point; j < cluster.first_point + cluster.count; ++j)
        faced[k] |= bit_of(side_of(tree.points[j].normal));
    }
    if (k != 0) faced[cluster.parent] |= faced[k];
  }
  return faced;
}

/// The cluster's flux of this side.
std::uint32_t flux_of(const FluxSides& sides, std::size_t cluster, std::size_t side) {
  std::uint32_t at = sides.begin[cluster];
  while (sides.side[at] != all_sides && sides.side[at] != side)
    ++at;
  return at;
}

} // namespace

bool FluxSides::whole(std::size_t cluster) const {
  return side[begin[cluster]] == all_sides;
}

FluxSides flux_sides(const ClusterTree& tree) {
  const std::vector<std::uint8_t> faced = faced_sides(tree);
  FluxSides sides;
  for (std::size_t k = 0; k < tree.nodes.size(); ++k) {
    const Cluster& cluster = tree.nodes[k];
    const auto add = [&](std::uint8_t side, std::size_t of_parent) {
      sides.side.push_back(side);
      sides.into.push_back(k == 0 ? 0 : flux_of(sides, cluster.parent, of_parent));
    };
    sides.begin.push_back(static_cast<std::uint32_t>(sides.side.size()));
    if (has_one_flux(cluster)) {
      add(all_sides, side_of(cluster.axis));
      continue;
    }
    for (std::size_t side = 0; side < side_count; ++side)
      if ((faced[k] & bit_of(side)) != 0) add(static_cast<std::uint8_t>(side), side);
  }
  sides.begin.push_back(static_cast<std::uint32_t>(sides.side.size()));
  return sides;
}

void update_cluster_fluxes(const ClusterTree& tree, const FluxSides& sides, View<ExchangePoint> points,
                           View<double> radiosity, LinearisationPoint about, std::vector<ClusterFlux>& fluxes) {
  const std::size_t clusters = tree.nodes.size();
  std::vector<Sums> sums(sides.side.size());
  parallel_ranges(clusters, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Cluster& cluster = tree.nodes[k];
      if (!is_leaf(cluster)) continue;
      for (std::uint32_t j = cluster.first_point; j < cluster.first_point + cluster.count; ++j) {
        const std::uint32_t at = sides.whole(k) ? sides.begin[k] : flux_of(sides, k, side_of(points[j].n));
        sums[at].add(points[j], radiosity.data + 3 * static_cast<std::size_t>(j));
      }
    }
  });
  for (std::size_t at = sums.size(); at-- > sides.begin[1];)
    sums[sides.into[at]].add(sums[at]);
  fluxes.resize(sums.size());
  for (std::size_t at = 0; at < sums.size(); ++at) {
    ClusterFlux& f = fluxes[at];
    std::copy_n(sums[at].flux, 3, f.flux);
    f.power = sums[at].power;
    if (about == LinearisationPoint::kept) continue;
    f.centre = sums[at].centre();
    for (int c = 0; c < 3; ++c)
      f.linearisation[c] = f.flux[c].squaredNorm() > 0.0 ? f.flux[c] : sums[at].normal;
  }
}

} // namespace pointgi
