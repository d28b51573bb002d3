#pragma once
/// How a method that is an operator H(B) solves for light that enters.
#include "host/radiosity/method.h"

namespace pointgi {

/// The points that exchange light, given by where each stands in the pool.
struct ExchangedPoints {
  View<Splat> pool;
  View<std::uint32_t> place;

  std::size_t size() const { return place.size; }
  const Splat& operator[](std::size_t k) const { return pool[place[k]]; }
};

/// What there is to solve, in the order of the exchanged points.
struct ExchangeProblem {
  std::vector<float> emission, albedo; ///< [points x 3]: E with rho H_direct, W/m²; rho
  std::vector<float> area;             ///< [points]
};

/// Throws std::invalid_argument on sizes that differ.
ExchangeProblem exchange_problem(const ExchangedPoints& exchanged, const EnteringLight& light);

/// Of a pool in which nothing exchanges light.
RadiosityField dark_field(const EnteringLight& light);

/// Irradiance [points x 3] of the exchanged points as one of all points of the pool, of so many numbers.
std::vector<float> irradiance_of_pool(View<double> irradiance, const ExchangedPoints& exchanged, std::size_t size);

/// PreparedRadiosity::solve by `device`, whose points are these; where there are none it is dark, and `device` may be
/// nullptr.
RadiosityField solve_by_operator(RadiosityOperator* device, const ExchangedPoints& exchanged,
                                 const EnteringLight& light, double tolerance, const WorkReport& report);

} // namespace pointgi
