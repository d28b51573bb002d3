#pragma once
/// What the exchange of light between surfaces will take, told by small parts of its work that are done for real.
#include "host/stages/indirect_stages.h"

namespace pointgi {

/// Of the stage `vmap` and that of the method.
struct ExchangeEstimate {
  double vmap_seconds = 0.0;                         ///< 0 where the method needs no map
  double prepare_seconds = 0.0, solve_seconds = 0.0; ///< of the method's stage, without direct light
  std::uint64_t vmap_bytes = 0, method_bytes = 0;    ///< of the device, besides what it holds before
  double links = 0.0, rays = 0.0;                    ///< of the map; IndirectLight::rays
  unsigned applies = 0;                              ///< of the operator, or passes
  std::optional<DeviceCones> at_pixels;              ///< as IndirectLight has them, of some light
};

/// What is known of a scene before light is exchanged in it.
struct ExchangeKnown {
  EnteringLight light;       ///< direct light, and what shines
  const ClusterTree& tree;   ///< of the points that exchange light; read for "fmm" alone
  const LinkEstimate& links; ///< of the map; the same
};

/// A solution by few directions tells how many applies the light needs; the method itself, over every so manieth
/// point, what these and its rays cost. Of "cones" the voxels are all made. Kernels are built, and run once, before any
/// time counts. Keeps no V-map. Throws what RadiosityMethod::prepare and solve throw.
ExchangeEstimate sample_exchange(Session& session, const ExchangeScene& exchange, const RadiositySettings& settings,
                                 const RadiosityMethod& method, const ExchangeKnown& known);

/// Passes that method "gather" needs where each leaves `history` of the power of what entered, the shares of which go
/// on falling as the last ones do.
unsigned passes_until(const std::vector<double>& history, double tolerance);

} // namespace pointgi
