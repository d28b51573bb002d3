#pragma once
/// When 32-bit coordinates are too coarse for the cloud they describe.
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

/// A warning when the spacing of 32-bit floats (ULP) at the largest coordinate is more than 1e-5 of the diagonal of the
/// bounding box; it gives both. Points that are not finite are left out. [positions: world units]
/// `stored_as_float`: which of x, y and z came as floats.
std::optional<std::string> float_precision_warning(const std::vector<Eigen::Vector3d>& positions,
                                                   const std::array<bool, 3>& stored_as_float);

} // namespace pointgi
