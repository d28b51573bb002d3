#pragma once
/// Which points of a cloud are wanted: chosen before anything is estimated from them.
#include "host/cloud/point_cloud.h"
#include <limits>
#include <optional>

namespace pointgi {

/// A point passes if the field's value is one of `values`, or where there are none lies in [min, max]. NaN never
/// passes.
struct FieldCondition {
  std::string field; ///< of the file; upper and lower case are the same, and so are "class" and "classification"
  std::vector<double> values;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// What lies on the plane or on the side of its normal stays.
struct ClipPlane {
  Eigen::Vector3d point;
  Eigen::Vector3d normal; ///< of any length above 0
};

/// A box, its faces included.
struct CropBox {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
};

/// Filters, used in this order; lengths and places in the file's coordinates.
struct Selection {
  std::vector<FieldCondition> keep; ///< a point passes all of them
  std::optional<CropBox> crop;
  std::vector<ClipPlane> clip; ///< a point passes all of them
  /// Edge of the cubes of a grid through the origin, of which each keeps one point: the nearest to its middle, of equal
  /// ones the first in the file.
  std::optional<double> voxel;

  bool empty() const { return keep.empty() && !crop && clip.empty() && !voxel; }
};

/// The fields that a reader must keep for the selection: all names under which a file may have them.
std::vector<std::string> fields_of(const Selection& selection);

/// Removes the points that do not pass, and those without a finite position where a crop, a clip or a voxel asks for
/// one. Without a file's fields, `keep` knows x, y, z, nx, ny, nz, red, green, blue (0 to 1) and radius of the cloud.
/// Counts in `report.points_left_out` and notes what each filter took. Throws Error(input) where a field does not
/// exist, or no point is left: it says which filter took the last, and what there was. O(n).
void select_points(PointCloud& cloud, const Selection& selection, CloudReport& report);

} // namespace pointgi
