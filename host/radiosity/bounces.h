#pragma once
/// Light a bounce at a time: what progressive refinement solves by (method.md section 8).
#include "host/radiosity/solve_by_operator.h"

namespace pointgi {

struct BounceOptions {
  double tolerance = 1e-3;  ///< power that is still to come, as the last passes fell, over the power of what entered
  unsigned only_passes = 0; ///< bounces, at most; 0: until the tolerance is reached
  /// Each pass gathers all light anew, B = E + rho H(B), instead of what the pass before has added: of a pass whose
  /// exchange gets better from pass to pass.
  bool whole = false;
  PassWatch after_pass; ///< may be empty
};

/// Pass `number` of the exchange: irradiance [points x 3] of radiosity [points x 3]. Returns whether later passes will
/// exchange light as well as this one and no better.
using ExchangePass = std::function<bool(View<double> radiosity, unsigned number, std::vector<double>& irradiance)>;

/// As solve_by_operator. Solution::residual: the power that the last pass added over that of what entered;
/// Solution::applies: passes.
RadiosityField solve_by_bounces(const ExchangePass& pass, const ExchangedPoints& exchanged, const EnteringLight& light,
                                const BounceOptions& options);

} // namespace pointgi
