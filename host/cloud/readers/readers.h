#pragma once
/// Which file is read by whom: a row a format. A new format is one file of this folder and one row of the table.
#include "host/cloud/point_cloud.h"
#include <string>
#include <vector>

namespace pointgi {

/// What is wanted of a file besides positions, normals, colours, radii and stations.
struct ReadRequest {
  double spacing = 0.0;            ///< distance of the samples of a mesh, the file's units; 0: chosen
  std::vector<std::string> fields; ///< names of fields that PointCloud::fields is to hold, where the file has them
  bool all_fields = false;         ///< every field that the file has, in its order, positions and colours included
};

struct CloudReader {
  const char* format;                  ///< as the documentation calls it
  std::vector<std::string> extensions; ///< ".ply", in lower case
  /// Whether the first bytes (up to 4096, as many as the file has) are this format's; null: cannot be told by content.
  bool (*recognises)(const char* data, std::size_t size);
  /// The points of the file, with what it says of them; null: the format is known and not read. Throws Error(input).
  PointCloud (*read)(const std::string& path, const ReadRequest& request, CloudReport& report);
  /// Of a format that is not read: what to do instead.
  const char* instead = nullptr;
};

const std::vector<CloudReader>& cloud_readers();

/// Reads the file: by its extension, unless the content is recognisably another row's; without a row for the
/// extension by its content, else as a mesh. Throws Error(input), for a format that is known and not read with what to
/// do instead.
PointCloud read_cloud(const std::string& path, const ReadRequest& request, CloudReport& report);

} // namespace pointgi
