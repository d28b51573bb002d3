#pragma once
/// Clusters as one flux vector a colour, as mid links take them (method.md section 4).
#include "fmm/operators/point_pair.h"
#include "fmm/solve/radiosity_operator.h"
#include "octree/vmap/cluster_tree.h"

namespace pointgi {

struct ClusterFlux {
  Eigen::Vector3d centre{0, 0, 0}; ///< centroid of the points weighted by the power of all colours together
  Eigen::Vector3d flux[3];         ///< sum of B A n, a colour each
  Eigen::Vector3d judge[3];        ///< a receiver on whose side this points gets flux . r, all others nothing
  double power = 0.0;              ///< sum of B A over points and colours
};

/// Updates one a cluster from radiosity [points x 3]; with Judge::before centre and judge stay as they are. Linear in
/// the number of points.
void update_cluster_fluxes(const ClusterTree& tree, View<ExchangePoint> points, View<double> radiosity, Judge judge,
                           std::vector<ClusterFlux>& fluxes);

} // namespace pointgi
