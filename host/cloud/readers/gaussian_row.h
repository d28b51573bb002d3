#pragma once
/// One Gaussian on its way from a packed file to the fields that plain PLY files of Gaussians have.
#include "host/cloud/readers/field_plan.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace pointgi {

struct GaussianRow {
  std::array<double, 3> position{};
  std::array<double, 3> colour{};    ///< [0,1], or beyond where the constant harmonic says so
  double opacity = 1.0;              ///< [0,1]
  std::array<double, 3> log_scale{}; ///< natural logarithms of the axes
  std::array<double, 4> rotation{};  ///< w x y z

  /// Values of the fields that plan_gaussians() plans.
  std::array<double, 14> fields() const {
    std::array<double, 14> row;
    for (std::size_t k = 0; k < 3; ++k) {
      row[k] = position[k];
      row[3 + k] = (colour[k] - 0.5) / harmonic_constant;
      row[7 + k] = log_scale[k];
    }
    row[6] = std::log(opacity / (1.0 - opacity)); // infinite at the ends, which says it
    std::copy(rotation.begin(), rotation.end(), row.begin() + 10);
    return row;
  }

  static constexpr double harmonic_constant = 0.28209479177387814; // 1 / (2 sqrt(pi))
};

/// Fills in the largest of a quaternion's values, which packed ones leave out: it is not negative and makes it unit.
inline void complete_quaternion(std::array<double, 4>& rotation, std::size_t largest) {
  double rest = 1.0;
  for (std::size_t k = 0; k < 4; ++k)
    rest -= k == largest ? 0.0 : rotation[k] * rotation[k];
  rotation[largest] = std::sqrt(std::max(0.0, rest));
}

inline FieldPlan plan_gaussians(const ReadRequest& request, const std::string& file, CloudReport& report) {
  std::vector<FieldInfo> fields;
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                           "rot_0", "rot_1", "rot_2", "rot_3"})
    fields.push_back({name, FieldType::f32});
  return plan_fields(std::move(fields), request, file, "byte 0", report);
}

} // namespace pointgi
