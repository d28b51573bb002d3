#pragma once
/// Clusters as a few flux vectors a colour, as mid links take them (method.md section 4).
#include "fmm/operators/point_pair.h"
#include "fmm/solve/radiosity_operator.h"
#include "octree/vmap/cluster_tree.h"

namespace pointgi {

/// Which flux vectors a cluster has. One where its normals lie close together; else one for each side, of the six that
/// a cube has, that some of its points face: in a single one, what the sides of a box send would cancel.
struct FluxSides {
  std::vector<std::uint32_t> begin; ///< cluster k has the fluxes [begin[k], begin[k + 1]); one more than clusters
  std::vector<std::uint8_t> side;   ///< of each flux, 0 to 5: +x, -x, +y ...; or all_sides
  std::vector<std::uint32_t> into;  ///< of each flux, that of the cluster's parent of which it is a part; the root's: 0

  bool whole(std::size_t cluster) const; ///< whether it has one flux of all its points
};
constexpr std::uint8_t all_sides = 6;

FluxSides flux_sides(const ClusterTree& tree);

/// The points of a cluster that face one side.
struct ClusterFlux {
  Eigen::Vector3d centre{0, 0, 0};  ///< centroid of the points weighted by the power of all colours together
  Eigen::Vector3d flux[3];          ///< sum of B A n, a colour each
  Eigen::Vector3d linearisation[3]; ///< a receiver on whose side this points gets flux . r, all others nothing
  double power = 0.0;               ///< sum of B A over points and colours
};

/// Updates all fluxes from radiosity [points x 3]; with LinearisationPoint::kept centre and linearisation stay as they
/// are. Linear in the number of points.
void update_cluster_fluxes(const ClusterTree& tree, const FluxSides& sides, View<ExchangePoint> points,
                           View<double> radiosity, LinearisationPoint about, std::vector<ClusterFlux>& fluxes);

} // namespace pointgi
