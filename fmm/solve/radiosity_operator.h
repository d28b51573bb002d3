#pragma once
/// H(B): what a solver asks of whoever computes it, host or device.
#include "octree/view.h"
#include <cstddef>
#include <vector>

namespace pointgi {

/// The flux of a source decides to which side its mid links shine and where its centroid is, so H is not quite
/// linear in B.
enum class LinearisationPoint {
  current, ///< the flux of this B >= 0, which is kept
  kept     ///< the flux that was kept last: linear in B, of any sign, as Krylov methods need
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
  virtual void apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) = 0;
};

} // namespace pointgi
