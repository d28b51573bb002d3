#pragma once
/// Which file is read by whom: a row a format. A new format is one file of this folder and one row of the table.
#include "host/cloud/point_cloud.h"
#include <string>
#include <vector>

namespace pointgi {

struct CloudReader {
  std::vector<std::string> extensions; ///< ".ply", in lower case; none: whatever no other row takes
  /// The points of the file, with what it says of them; null: the format is known and not read. `spacing`: distance of
  /// the samples of a mesh, the file's units; 0: chosen. Throws Error(input).
  PointCloud (*read)(const std::string& path, double spacing, CloudReport& report);
};

const std::vector<CloudReader>& cloud_readers();

/// Reads the file by the row of its extension. Throws Error(input), for a format that is known and not read with what
/// to do instead.
PointCloud read_cloud(const std::string& path, double spacing, CloudReport& report);

} // namespace pointgi
