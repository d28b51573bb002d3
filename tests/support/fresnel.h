#pragma once
/// Fresnel's equations by angles, as optics books have them: the kernels have them by cosines.
#include <cmath>

namespace pointgi::test {

/// Share of unpolarised light that is reflected. degrees: from the normal, 0 to 90; eta: refractive index behind the
/// surface over that before it, > 0. 1 where reflection is total.
inline double fresnel(double degrees, double eta) {
  const double i = degrees * 3.14159265358979323846 / 180.0, sine = std::sin(i) / eta;
  if (sine >= 1.0) return 1.0;
  const double t = std::asin(sine);
  if (i < 1e-9) return std::pow((eta - 1.0) / (eta + 1.0), 2);
  const double across = std::sin(i - t) / std::sin(i + t), along = std::tan(i - t) / std::tan(i + t);
  return 0.5 * (across * across + along * along);
}

} // namespace pointgi::test
