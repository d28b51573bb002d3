#pragma once
/// What photons are aimed at: clusters of splats of specular materials (method.md §5).
#include "octree/splat.h"
#include "octree/view.h"
#include "shared/photon_types.h"
#include <functional>
#include <vector>

namespace pointgi {

struct SpecularLeaves {
  std::vector<PhotonLeaf> leaves;
  std::vector<std::uint32_t> splats;  ///< leaf after leaf: indices into the point pool
  std::vector<std::uint32_t> leaf_of; ///< of each point of the pool, or NO_PHOTON_LEAF
  std::vector<float> axis;            ///< 3 a leaf: unit mean normal
  std::vector<float> area;            ///< 1 a leaf: sum of the effective areas, root cube squared
};

/// Clusters of splats whose spheres cover little that is not theirs, at most `most` of them. `all_small`: none larger
/// than some 32 near-planar splats, whatever their spheres cover, for whom discs are to stand for them.
SpecularLeaves specular_leaves(View<Splat> points, const std::function<bool(const Splat&)>& specular, std::size_t most,
                               bool all_small);

} // namespace pointgi
