#pragma once
#include <vector>

namespace pointgi {

/// Mean structural similarity of two planes of width x height values in [0, 1], row after row (Wang et al. 2004), over
/// Gaussian windows (sigma 1.5, 11 x 11). Only whole windows count, as in the authors' program and in scikit-image:
/// figures can be compared with published ones. Along a side of less than 11 pixels, where there is none, each pixel's
/// window counts as far as it lies inside, its weights divided by their sum.
double ssim(const std::vector<float>& a, const std::vector<float>& b, int width, int height);

} // namespace pointgi
