#pragma once
/// The transfer curve of sRGB (IEC 61966-2-1). Both functions go on beyond [0,1] by the same formulas; NaN stays NaN.
#include <cmath>

namespace pointgi {

/// Encoded value [0,1] -> linear light [0,1].
inline float srgb_to_linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Linear light [0,1] -> encoded value [0,1]; the inverse of srgb_to_linear.
inline float linear_to_srgb(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

} // namespace pointgi
