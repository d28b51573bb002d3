#include "fmm/operators/cluster_flux.h"
#include "octree/parallel.h"

namespace pointgi {

namespace {

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

} // namespace

void update_cluster_fluxes(const ClusterTree& tree, View<ExchangePoint> points, View<double> radiosity, Judge judge,
                           std::vector<ClusterFlux>& fluxes) {
  const std::size_t clusters = tree.nodes.size();
  fluxes.resize(clusters);
  std::vector<Sums> sums(clusters);
  parallel_ranges(clusters, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Cluster& cluster = tree.nodes[k];
      if (cluster.child_count == 0)
        for (std::uint32_t j = cluster.first_point; j < cluster.first_point + cluster.count; ++j)
          sums[k].add(points[j], radiosity.data + 3 * static_cast<std::size_t>(j));
    }
  });
  for (std::size_t k = clusters; k-- > 1;)
    sums[tree.nodes[k].parent].add(sums[k]);
  for (std::size_t k = 0; k < clusters; ++k) {
    ClusterFlux& f = fluxes[k];
    std::copy_n(sums[k].flux, 3, f.flux);
    f.power = sums[k].power;
    if (judge == Judge::before) continue;
    const float* middle = tree.nodes[k].centre;
    f.centre =
        f.power > 0.0 ? Eigen::Vector3d(sums[k].moment / f.power) : Eigen::Vector3d(middle[0], middle[1], middle[2]);
    for (int c = 0; c < 3; ++c)
      f.judge[c] = f.flux[c].squaredNorm() > 0.0 ? f.flux[c] : sums[k].normal;
  }
}

} // namespace pointgi
