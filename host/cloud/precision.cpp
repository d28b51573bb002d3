#include "host/cloud/precision.h"
#include "octree/parallel.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace pointgi {

namespace {

struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;

  Bounds& operator+=(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
    return *this;
  }
};

} // namespace

std::optional<std::string> float_precision_warning(const std::vector<Eigen::Vector3d>& positions,
                                                   const std::array<bool, 3>& stored_as_float) {
  const Bounds bounds =
      parallel_sum(positions.size(), 1 << 16, Bounds(), [&](Bounds& sum, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          if (positions[i].allFinite()) sum += {positions[i], positions[i]};
      });
  const Eigen::Vector3d &low = bounds.low, &high = bounds.high;
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
