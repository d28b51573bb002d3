#pragma once
/// Points that lie close together, for what they see, share what their rays have found (after Ward, Rubinstein and
/// Clear, "A ray tracing solution for diffuse interreflection", 1988): noise averages out where irradiance changes
/// slowly.
#include "host/cloud/knn.h"
#include "octree/splat.h"
#include <memory>

namespace pointgi {

class SharedIrradiance {
public:
  /// Of the points at `places` of `pool`, both of which must outlive this. `ways`: of each the harmonic mean of the
  /// lengths of its rays [unit of the positions]: irradiance changes over that length, and no faster. Among more than
  /// `most_searched` points, of which a search would take 120 bytes each, neighbours are those before and behind in the
  /// pool, whose order keeps together what lies together.
  SharedIrradiance(View<Splat> pool, View<std::uint32_t> places, std::vector<float> ways,
                   std::size_t most_searched = 2'000'000);

  /// of_pool [points of the pool x channels] becomes, where the points lie, the mean of `values` [points x channels]
  /// over each and its neighbours, weighted by 1 - e / least_error, where e = distance / way + sqrt(1 - cosine of the
  /// normals) is Ward's bound of the error that the neighbour's value has here; up to most_neighbours of them.
  void share(View<float> values, std::size_t channels, std::vector<float>& of_pool) const;

  static constexpr double least_error = 0.15;
  static constexpr unsigned most_neighbours = 24;

private:
  class Mean;
  void share_with_searched(View<float> values, std::size_t channels, std::vector<float>& of_pool) const;
  void share_along_pool(View<float> values, std::size_t channels, std::vector<float>& of_pool) const;
  /// Of neighbour j's value at point i; at most 0: none.
  double weight(std::size_t i, std::size_t j) const;
  const Splat& point(std::size_t i) const { return pool_[places_[i]]; }

  View<Splat> pool_;
  View<std::uint32_t> places_;
  std::vector<float> ways_;
  std::unique_ptr<Sites> sites_; ///< null: too few points, or too many
};

} // namespace pointgi
