#pragma once
/// H(B): what a solver asks of whoever computes it, host or device.
#include "octree/view.h"
#include <cstddef>
#include <vector>

namespace pointgi {

/// Mid links judge by the flux of the source to which side it shines and where its centroid is, so H is not quite
/// linear in B.
enum class Judge {
  now,   ///< by the flux of this B >= 0, which is kept
  before ///< by the flux kept last: linear in B, of any sign, as Krylov methods need
};

class RadiosityOperator {
public:
  virtual ~RadiosityOperator() = default;
  RadiosityOperator() = default;
  RadiosityOperator(const RadiosityOperator&) = delete;
  RadiosityOperator& operator=(const RadiosityOperator&) = delete;

  virtual std::size_t points() const = 0;
  /// irradiance [points x 3, W/m^2] of radiosity [points x 3, W/m^2]; a row a point in tree order, RGB. Same bits for
  /// any number of threads. `irradiance` is resized.
  virtual void apply(View<double> radiosity, Judge judge, std::vector<double>& irradiance) = 0;
};

} // namespace pointgi
