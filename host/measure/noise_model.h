#pragma once
/// How much noise pictures have, by what the variances of their pixels tell.
#include <algorithm>
#include <cmath>

namespace pointgi {

/// Variances tell the noise of samples that know nothing of each other, which falls as 1 over their number. Those of a
/// pixel are stratified: their noise is less, and falls faster (Mitchell 1996: with the power 1.5 where an edge crosses
/// the pixel).
struct NoiseModel {
  double factor = 1.0, power = 1.0; ///< noise is factor * (that of one sample) / samples^power

  /// relMSE of the noise; `of_one`: what variances tell of one sample a pixel.
  double noise(double of_one, double samples) const { return factor * of_one / std::pow(samples, power); }

  /// Samples a pixel whose noise is `noise`, above 0.
  double samples(double of_one, double noise) const {
    return std::pow(std::max(0.0, factor * of_one / noise), 1.0 / power);
  }
};

} // namespace pointgi
