#pragma once
/// How a method that is an operator H(B) solves for light that enters.
#include "host/radiosity/method.h"

namespace pointgi {

/// The points that exchange light, and where each stands in the pool.
struct ExchangedPoints {
  View<Splat> points;
  View<std::uint32_t> place;
};

/// PreparedRadiosity::solve by `device`, whose points are these; where there are none it is dark, and `device` may be
/// nullptr.
RadiosityField solve_by_operator(RadiosityOperator* device, const ExchangedPoints& exchanged,
                                 const EnteringLight& light, double tolerance, const WorkReport& report);

} // namespace pointgi
