#pragma once
#include <vector>

namespace pointgi {

/// Mean structural similarity of two planes of width x height values in [0, 1], row after row (Wang et al. 2004). Each
/// pixel's Gaussian window (sigma 1.5, 11 x 11) is cut off at the borders and its weights divided by their sum, so
/// small pictures have one too.
double ssim(const std::vector<float>& a, const std::vector<float>& b, int width, int height);

} // namespace pointgi
