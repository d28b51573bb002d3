#pragma once
/// The descent of method.md §2 on the host: the truth beside kernels/traverse/octree_descent.cl.
#include "octree/pack/step_pools.h"
#include <array>

namespace pointgi {

template <std::size_t D>
struct DescentStep {
  unsigned child = 0;          ///< linearised x + N*y (+ N*N*z)
  std::array<float, D> inside; ///< position inside the child, [0,1)^D
};

/// One step of the descent in an N^D tree: n = c + int(p*N), p = p*N - int(p*N).
template <std::size_t D>
DescentStep<D> descend_step(const std::array<float, D>& p, unsigned n) {
  DescentStep<D> step{};
  unsigned stride = 1;
  for (std::size_t a = 0; a < D; ++a) {
    const float scaled = p[a] * static_cast<float>(n);
    const auto whole = static_cast<unsigned>(scaled);
    step.child += stride * whole;
    step.inside[a] = scaled - static_cast<float>(whole);
    stride *= n;
  }
  return step;
}

/// The leaf or empty node that holds p, in [0,1)^3.
inline OctreeNode descend(const StepPools& pools, std::array<float, 3> p) {
  OctreeNode node = pools.nodes[0];
  while (NODE_TYPE(node.header) == NODE_INTERNAL) {
    const DescentStep<3> step = descend_step(p, 1u << pools.axis_bits);
    node = pools.nodes[node.address + step.child];
    p = step.inside;
  }
  return node;
}

} // namespace pointgi
