#pragma once
/// How far two pictures are apart, in figures that are usual for renderings.
#include "host/image/picture_writer.h"

namespace pointgi {

/// Of A against B, which is taken for the truth. Radiance as the files hold it.
struct Difference {
  double mean_a = 0.0, mean_b = 0.0;
  double mse = 0.0;     ///< mean of (a - b)²
  double rel_mse = 0.0; ///< mean of (a - b)² / (b² + eps)
  double bias = 0.0;    ///< (mean a - mean b) / mean b; 0 where both are 0, infinite where only mean b is
  double p99 = 0.0;     ///< 99th percentile of |a - b|: 99 % of the values are no farther apart
  double ssim = 1.0;    ///< structural similarity, 1 for equal pictures
};

struct PictureDifference {
  Difference channel[3];      ///< R, G, B
  Difference all;             ///< of all values of R, G and B; ssim is the mean of the three
  PixelWindow area;           ///< common to both data windows, in which all figures are taken
  double eps = 0.0;           ///< of rel_mse: 0.01 times the squared mean of B; 0.01 for a black B
  double white = 0.0;         ///< the radiance that is 1 in ssim: the 99th percentile of B
  std::size_t pixels = 0;     ///< compared
  std::size_t not_finite = 0; ///< left out: pixels with a NaN or an infinity in either picture
};

/// Both data windows count from the corners of their displayWindows. SSIM (Wang, Bovik, Sheikh and Simoncelli, "Image
/// quality assessment", 2004: Gaussian window of sigma 1.5 over 11 x 11 pixels, K1 = 0.01, K2 = 0.03) looks at what a
/// viewer sees: values over `white`, through the curve of sRGB, cut off at 1. Its windows are whole
/// (host/image/ssim.h). The names are for errors. Throws Error(input) where R, G or B is missing or the windows have no
/// pixel in common.
PictureDifference difference(const Picture& a, const std::string& name_a, const Picture& b, const std::string& name_b);

} // namespace pointgi
