#pragma once
/// Where readers put points: rows of values become attributes, and what the values mean (ranges of colours, packed
/// colours, Gaussians) is decided once for all formats.
#include "host/cloud/readers/field_plan.h"

namespace pointgi {

class PointSink {
public:
  /// `count` points, 1 to 2^32 - 1, whose memory is taken here: readers check counts against the file's size before.
  /// Throws Error(memory).
  PointSink(FieldPlan plan, std::size_t count, const std::string& file);

  /// Values of the plan's fields, in their order; scale and offset applied. Rows of different points may come from
  /// different threads.
  void put(std::size_t point, const double* values);

  /// The cloud, once every point was put. Decides ranges of colours by nearly all points; turns packed colours,
  /// harmonics, scales and rotations into colours, radii and normals; normals of no length and those not finite become
  /// zero, which means missing. Adds warnings and notes to `report`.
  PointCloud finish(CloudReport& report);

private:
  FieldPlan plan_;
  std::string file_;
  PointCloud cloud_;
};

} // namespace pointgi
