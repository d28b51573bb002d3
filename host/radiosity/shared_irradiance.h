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
  /// Of the points at `places` of `pool`, which must outlive this. `ways`: of each the harmonic mean of the lengths of
  /// its rays [unit of the positions]: irradiance changes over that length, and no faster.
  SharedIrradiance(View<Splat> pool, const std::vector<std::uint32_t>& places, std::vector<float> ways);

  /// `values` [points x channels]: of each point the mean over itself and its neighbours, weighted by 1 - e /
  /// least_error, where e = distance / way + sqrt(1 - cosine of the normals) is Ward's bound of the error that the
  /// neighbour's value has here; up to most_neighbours of them.
  void share(std::vector<float>& values, std::size_t channels) const;

  static constexpr double least_error = 0.15;
  static constexpr unsigned most_neighbours = 24;

private:
  const Splat& point(std::size_t i) const { return pool_[places_[i]]; }

  View<Splat> pool_;
  std::vector<std::uint32_t> places_;
  std::vector<float> ways_;
  std::unique_ptr<Sites> sites_; ///< null: too few points
};

} // namespace pointgi
