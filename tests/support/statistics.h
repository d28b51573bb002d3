#pragma once
/// Whether two noisy pictures may be of the same thing: z-tests by their own Variance channels (after Mitsuba 3's tests
/// of renderings).
#include "host/image/picture_writer.h"
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace pointgi::test {

/// Of the values a - b, by the variances of their noise; pixels without noise in either must be equal.
struct ZTest {
  double of_mean = 0.0;     ///< of the mean difference, in standard deviations
  double largest = 0.0;     ///< of any pixel
  double mean_square = 0.0; ///< over pixels; 1 where the variance tells the noise rightly
  std::size_t unequal = 0;  ///< pixels that differ without noise
};

inline ZTest z_test(const Picture& a, const Picture& b, const std::string& colour) {
  const std::vector<float>&x = a.channels.at(colour), &y = b.channels.at(colour);
  const std::vector<float>&vx = a.channels.at("Variance." + colour), &vy = b.channels.at("Variance." + colour);
  ZTest z;
  double sum = 0.0, variance = 0.0;
  std::size_t noisy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = double{x[i]} - double{y[i]}, v = double{vx[i]} + double{vy[i]};
    sum += off;
    variance += v;
    // Sums in float: what they round off is no noise of the samples.
    if (v <= 1e-10 * double{x[i]} * double{x[i]}) {
      z.unequal += std::fabs(off) > 2e-5 * std::fabs(double{x[i]});
      continue;
    }
    z.largest = std::fmax(z.largest, std::fabs(off) / std::sqrt(v));
    z.mean_square += off * off / v;
    ++noisy;
  }
  z.of_mean = variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
  if (noisy > 0) z.mean_square /= static_cast<double>(noisy);
  return z;
}

} // namespace pointgi::test
