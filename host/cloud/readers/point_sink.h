#pragma once
/// Where readers put points: rows of values become attributes, and what the values mean (ranges of colours, packed
/// colours, Gaussians) is decided once for all formats.
#include "host/cloud/readers/field_plan.h"
#include "host/cloud/readers/gaussians.h"

namespace pointgi {

class PointSink {
public:
  /// `count` points, 1 to 2^32 - 1, whose memory is taken here: readers check counts against the file's size before.
  /// Throws Error(memory).
  PointSink(FieldPlan plan, std::size_t count, const std::string& file);

  /// Values of the plan's fields, in their order; scale and offset applied. Rows of different points may come from
  /// different threads. A packed colour in a float's bits may come as the integer that they are, its field then being
  /// of an integer type: floats that are no numbers lose bits on their way through a double.
  void put(std::size_t point, const double* values);

  /// The cloud, once every point was put. Decides ranges of colours by nearly all points; turns packed colours,
  /// harmonics, scales and rotations into colours, radii and normals; normals of no length and those not finite become
  /// zero, which means missing; if all are, there are none. Adds warnings and notes to `report`, and the count of
  /// points.
  PointCloud finish(CloudReport& report);

private:
  const double& value(const double* values, int slot) const {
    return values[field_of_[static_cast<std::size_t>(slot)]];
  }
  Eigen::Vector3d triple(const double* values, int slot) const {
    return {value(values, slot), value(values, slot + 1), value(values, slot + 2)};
  }
  void take_memory(std::size_t count);
  void put_gaussian(std::size_t point, const double* values);
  void finish_normals(CloudReport& report);

  FieldPlan plan_;
  std::string file_;
  PointCloud cloud_;
  std::array<std::size_t, slot_count> field_of_{}; ///< index of the field with each slot
  bool has_packed_ = false;
  bool is_flat_ = false; ///< Gaussians of two axes
  GaussianValues gaussians_;
};

} // namespace pointgi
