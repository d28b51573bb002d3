#pragma once
/// H(B) by the fast multipole method in double precision: the twin of the kernels (method.md section 4).
#include "fmm/lists/interaction_lists.h"
#include "fmm/operators/cluster_flux.h"
#include "fmm/solve/radiosity_operator.h"
#include <array>

namespace pointgi {

struct FmmOptions {
  GridOptions grid;
  ListOptions lists;
};

/// H_i = -(1/pi) n_i . F(x_i) + mid + near, where the far field F(x) = sum_j T(x_j - x) q_j, T_ab(r) = r_a r_b / |r|^4,
/// q_j = B_j A_j n_j, is interpolated between the clusters' grids.
class FmmOperator : public RadiosityOperator {
public:
  /// Keeps what it needs of the tree's points and takes its own copy of the links' lists; `tree` and `point_shares`
  /// (VMap::point_shares, where links refer to them) must outlive it.
  /// Throws std::invalid_argument as make_grids() and make_interaction_lists() do.
  FmmOperator(const ClusterTree& tree, View<Link> links, const FmmOptions& options,
              View<std::uint8_t> point_shares = {});

  std::size_t points() const override { return points_.size(); }
  void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) override;

  const Grids& grids() const { return grids_; }
  const InteractionLists& lists() const { return lists_; }

private:
  /// Values of an expansion, FMM_VALUES planes of nodes, each as long as Grids::nodes().
  using Expansion = std::array<std::vector<double>, FMM_VALUES>;

  void moments_of(std::uint32_t cluster, View<double> radiosity);
  void receive_far(std::uint32_t cluster);
  void receive_from_parent(std::uint32_t cluster);
  double share_of(const SourceLists& rows, std::uint32_t entry, std::uint32_t point_of_cluster) const;
  void evaluate_leaf(std::uint32_t leaf, View<double> radiosity, double* irradiance) const;

  const ClusterTree& tree_;
  Grids grids_;
  InteractionLists lists_;
  View<std::uint8_t> point_shares_;
  std::vector<ExchangePoint> points_;
  std::vector<std::vector<std::uint32_t>> levels_; ///< clusters of each level, the root first
  std::vector<std::uint32_t> leaves_;
  Expansion moments_, local_;
  FluxSides sides_;
  std::vector<ClusterFlux> fluxes_;
  bool has_linearisation_ = false;
};

} // namespace pointgi
