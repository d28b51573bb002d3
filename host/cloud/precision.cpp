#include "host/cloud/precision.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace pointgi {

std::optional<std::string> float_precision_warning(const std::vector<Eigen::Vector3d>& positions,
                                                   const std::array<bool, 3>& stored_as_float) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(infinity);
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& p : positions) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!(low.x() <= high.x())) return std::nullopt;
  const double diagonal = (high - low).norm();
  double farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    if (stored_as_float[static_cast<std::size_t>(axis)])
      farthest = std::max({farthest, std::abs(low[axis]), std::abs(high[axis])});
  const auto as_float = static_cast<float>(farthest);
  const double ulp = static_cast<double>(std::nextafter(as_float, std::numeric_limits<float>::infinity()) - as_float);
  // A cloud of one place has no size that the step could be compared with.
  if (!(diagonal > 0.0) || !(ulp > 1e-5 * diagonal)) return std::nullopt;
  char text[400];
  std::snprintf(text, sizeof text,
                "positions are stored as 32-bit floats far from the origin: at %.6g their step (ULP) is %.3g, which is "
                "%.2g of the cloud's diagonal of %.6g; store them as doubles or subtract an offset before saving.",
                farthest, ulp, ulp / diagonal, diagonal);
  return std::string(text);
}

} // namespace pointgi
