#include "fmm/operators/fmm_operator.h"
#include "octree/parallel.h"
#include <algorithm>
#include <stdexcept>

namespace pointgi {

namespace {

constexpr double inverse_pi = 0.31830988618379067154;

std::vector<std::vector<std::uint32_t>> levels_of(const ClusterTree& tree) {
  std::vector<std::vector<std::uint32_t>> levels;
  for (std::uint32_t k = 0; k < tree.nodes.size(); ++k) {
    if (tree.nodes[k].level >= levels.size()) levels.resize(tree.nodes[k].level + 1);
    levels[tree.nodes[k].level].push_back(k);
  }
  return levels;
}

/// Calls use(node, weight) for every node of the grid.
template <class Use>
void for_weights(const Grid& grid, const double x[3], const Use& use) {
  double w[3][FMM_MAX_ORDER];
  grid_weights(grid, x, w);
  std::uint32_t node = grid.first;
  for (unsigned z = 0; z < grid.axis[2]; ++z)
    for (unsigned y = 0; y < grid.axis[1]; ++y) {
      const double yz = w[2][z] * w[1][y];
      for (unsigned i = 0; i < grid.axis[0]; ++i)
        use(node++, yz * w[0][i]);
    }
}

/// Adds to h[3] what the points behind a flux vector send to a point.
void receive_flux(const ExchangePoint& p, const ClusterFlux& source, double visible, double* h) {
  const Eigen::Vector3d r = source.centre - p.x;
  const double r2 = r.squaredNorm(), facing = p.n.dot(r);
  if (!(facing > 0.0)) return;
  const double scale = visible * inverse_pi * facing / (r2 * r2);
  for (int c = 0; c < 3; ++c)
    if (source.linearisation[c].dot(r) < 0.0) h[c] -= scale * source.flux[c].dot(r);
}

} // namespace

FmmOperator::FmmOperator(const ClusterTree& tree, View<Link> links, const FmmOptions& options,
                         View<std::uint8_t> point_shares)
    : tree_(tree), grids_(make_grids(tree, options.grid)),
      lists_(make_interaction_lists(tree, links, point_shares.size, grids_, options.lists)),
      point_shares_(point_shares), points_(tree.points.begin(), tree.points.end()), levels_(levels_of(tree)),
      sides_(flux_sides(tree)) {
  for (std::uint32_t k = 0; k < tree.nodes.size(); ++k)
    if (tree.nodes[k].child_count == 0) leaves_.push_back(k);
  for (int value = 0; value < FMM_VALUES; ++value) {
    moments_[value].resize(grids_.nodes());
    local_[value].resize(grids_.nodes());
  }
}

/// P2M of a leaf, M2M of any other cluster.
void FmmOperator::moments_of(std::uint32_t k, View<double> radiosity) {
  const Cluster& cluster = tree_.nodes[k];
  const Grid& grid = grids_.of[k];
  for (auto& plane : moments_)
    std::fill_n(plane.begin() + grid.first, grid.count, 0.0);
  const auto spread = [&](const double x[3], const double values[FMM_VALUES]) {
    for_weights(grid, x, [&](std::uint32_t node, double weight) {
      for (int value = 0; value < FMM_VALUES; ++value)
        moments_[value][node] += weight * values[value];
    });
  };
  double values[FMM_VALUES];
  if (cluster.child_count == 0) {
    for (std::uint32_t j = cluster.first_point; j < cluster.first_point + cluster.count; ++j) {
      for (int value = 0; value < FMM_VALUES; ++value)
        values[value] = radiosity[3 * j + value / 3] * points_[j].area * points_[j].n[value % 3];
      spread(points_[j].x.data(), values);
    }
    return;
  }
  for (std::uint32_t c = cluster.first_child; c < cluster.first_child + cluster.child_count; ++c)
    for (std::uint32_t m = grids_.of[c].first; m < grids_.of[c].first + grids_.of[c].count; ++m) {
      for (int value = 0; value < FMM_VALUES; ++value)
        values[value] = moments_[value][m];
      const double x[3] = {grids_.position[0][m], grids_.position[1][m], grids_.position[2][m]};
      spread(x, values);
    }
}

/// M2L of all far sources of a cluster.
void FmmOperator::receive_far(std::uint32_t k) {
  const Grid& grid = grids_.of[k];
  for (auto& plane : local_)
    std::fill_n(plane.begin() + grid.first, grid.count, 0.0);
  const double *x = grids_.position[0].data(), *y = grids_.position[1].data(), *z = grids_.position[2].data();
  for (std::uint32_t entry = lists_.far.begin[k]; entry < lists_.far.begin[k + 1]; ++entry) {
    const Grid& source = grids_.of[lists_.far.source[entry]];
    const double share = lists_.far.share[entry];
    for (std::uint32_t l = grid.first; l < grid.first + grid.count; ++l) {
      double field[FMM_VALUES] = {};
      for (std::uint32_t m = source.first; m < source.first + source.count; ++m) {
        const double rx = x[m] - x[l], ry = y[m] - y[l], rz = z[m] - z[l];
        const double inverse2 = 1.0 / (rx * rx + ry * ry + rz * rz), inverse4 = inverse2 * inverse2;
        for (int c = 0; c < 9; c += 3) {
          const double along = inverse4 * (rx * moments_[c][m] + ry * moments_[c + 1][m] + rz * moments_[c + 2][m]);
          field[c] += rx * along;
          field[c + 1] += ry * along;
          field[c + 2] += rz * along;
        }
      }
      for (int value = 0; value < FMM_VALUES; ++value)
        local_[value][l] += share * field[value];
    }
  }
}

/// L2L.
void FmmOperator::receive_from_parent(std::uint32_t k) {
  const Grid &grid = grids_.of[k], &parent = grids_.of[tree_.nodes[k].parent];
  for (std::uint32_t l = grid.first; l < grid.first + grid.count; ++l) {
    const double x[3] = {grids_.position[0][l], grids_.position[1][l], grids_.position[2][l]};
    for_weights(parent, x, [&](std::uint32_t node, double weight) {
      for (int value = 0; value < FMM_VALUES; ++value)
        local_[value][l] += weight * local_[value][node];
    });
  }
}

/// The visible share of an entry of `rows` for a point, counted from the receiving cluster's first.
double FmmOperator::share_of(const SourceLists& rows, std::uint32_t entry, std::uint32_t point_of_cluster) const {
  const std::uint32_t own = rows.own_share[entry];
  return own == no_point_shares ? static_cast<double>(rows.share[entry])
                                : static_cast<double>(point_shares_[own + point_of_cluster]) / 255.0;
}

/// L2P, then the mid and near rows of the leaf and of all clusters above it.
void FmmOperator::evaluate_leaf(std::uint32_t leaf, View<double> radiosity, double* irradiance) const {
  const Cluster& cluster = tree_.nodes[leaf];
  for (std::uint32_t i = cluster.first_point; i < cluster.first_point + cluster.count; ++i) {
    const ExchangePoint& p = points_[i];
    double h[3] = {0.0, 0.0, 0.0};
    for_weights(grids_.of[leaf], p.x.data(), [&](std::uint32_t node, double weight) {
      for (int value = 0; value < FMM_VALUES; ++value)
        h[value / 3] -= inverse_pi * weight * p.n[value % 3] * local_[value][node];
    });
    for (std::uint32_t k = leaf;; k = tree_.nodes[k].parent) {
      const std::uint32_t place = i - tree_.nodes[k].first_point;
      for (std::uint32_t entry = lists_.mid.begin[k]; entry < lists_.mid.begin[k + 1]; ++entry) {
        const double visible = share_of(lists_.mid, entry, place);
        const std::uint32_t source = lists_.mid.source[entry];
        for (std::uint32_t f = sides_.begin[source]; f < sides_.begin[source + 1]; ++f)
          receive_flux(p, fluxes_[f], visible, h);
      }
      for (std::uint32_t entry = lists_.near_.begin[k]; entry < lists_.near_.begin[k + 1]; ++entry) {
        const Cluster& source = tree_.nodes[lists_.near_.source[entry]];
        const double visible = share_of(lists_.near_, entry, place);
        for (std::uint32_t j = source.first_point; j < source.first_point + source.count; ++j) {
          const double share = visible * point_exchange(p, points_[j]);
          for (int c = 0; c < 3; ++c)
            h[c] += share * radiosity[3 * j + c];
        }
      }
      if (k == 0) break;
    }
    std::copy_n(h, 3, irradiance + 3 * i);
  }
}

void FmmOperator::apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) {
  if (radiosity.size != 3 * points_.size()) throw std::invalid_argument("radiosity is not [points x 3]");
  if (about == LinearisationPoint::kept && !has_linearisation_)
    throw std::invalid_argument("no linearisation point is kept");
  has_linearisation_ = true;
  irradiance.resize(3 * points_.size());
  const auto for_all = [](const std::vector<std::uint32_t>& clusters, const auto& body) {
    parallel_ranges(clusters.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        body(clusters[k]);
    });
  };
  update_cluster_fluxes(tree_, sides_, points_, radiosity, about, fluxes_);
  for (std::size_t level = levels_.size(); level-- > 0;)
    for_all(levels_[level], [&](std::uint32_t k) { moments_of(k, radiosity); });
  for (std::size_t level = 0; level < levels_.size(); ++level)
    for_all(levels_[level], [&](std::uint32_t k) {
      receive_far(k);
      if (k != 0) receive_from_parent(k);
    });
  for_all(leaves_, [&](std::uint32_t leaf) { evaluate_leaf(leaf, radiosity, irradiance.data()); });
}

} // namespace pointgi
