#include "host/cloud/readers/byte_stream.h"
#include "host/cloud/readers/ply.h"

namespace pointgi {

namespace {

/// A colour channel as the usual byte; what is no number becomes black.
std::uint8_t to_byte(float channel) {
  return nearest_integer<std::uint8_t>(static_cast<double>(channel * 255.0f));
}

/// Such a mismatch is a fault of the caller's, not of the user's.
void require_matching(const std::string& path, const std::string& what, std::size_t length, std::size_t expected) {
  if (length != expected)
    throw Error(ErrorKind::internal, path + ": writing " + what + ": " + std::to_string(length) + " values for " +
                                         std::to_string(expected) + " points");
}

void check(const std::string& path, const PointCloud& cloud, const std::vector<PlyColumn>& columns) {
  const std::size_t count = cloud.size();
  if (!cloud.normal.empty()) require_matching(path, "normals", cloud.normal.size(), count);
  if (!cloud.colour.empty()) require_matching(path, "colours", cloud.colour.size(), count);
  if (!cloud.radius.empty()) require_matching(path, "radii", cloud.radius.size(), count);
  for (const PlyColumn& column : columns) {
    require_matching(path, "column " + column.name, column.values.size(), count);
    if (column.name.empty() || column.name.find_first_of(" \t\r\n\v\f") != std::string::npos)
      throw Error(ErrorKind::internal, path + ": \"" + column.name + "\" is no name for a PLY property");
  }
}

std::string header_of(const PointCloud& cloud, const std::vector<PlyColumn>& columns, const char* index_type) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment written by pointgi\nelement vertex " +
                     std::to_string(cloud.size()) + "\n";
  text += "property double x\nproperty double y\nproperty double z\n";
  if (!cloud.normal.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!cloud.colour.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!cloud.radius.empty()) text += "property float radius\n";
  for (const PlyColumn& column : columns)
    text += "property float " + column.name + "\n";
  if (!cloud.triangle.empty())
    text += "element face " + std::to_string(cloud.triangle.size()) + "\nproperty list uchar " + index_type +
            " vertex_indices\n";
  return text + "end_header\n";
}

} // namespace

void write_ply(const std::string& path, const PointCloud& cloud, const std::vector<PlyColumn>& columns) {
  check(path, cloud, columns);
  AtomicFile file(path);
  ByteStream out(file);
  // int is what every reader knows; uint only where int cannot count that far.
  const bool int_is_enough = cloud.size() <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  out.text(header_of(cloud, columns, int_is_enough ? "int" : "uint"));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      out.put(cloud.position[i][k]);
    for (int k = 0; k < 3 && !cloud.normal.empty(); ++k)
      out.put(cloud.normal[i][k]);
    for (int k = 0; k < 3 && !cloud.colour.empty(); ++k)
      out.put(to_byte(cloud.colour[i][k]));
    if (!cloud.radius.empty()) out.put(cloud.radius[i]);
    for (const PlyColumn& column : columns)
      out.put(column.values[i]);
  }
  for (const auto& corners : cloud.triangle) {
    out.put(std::uint8_t{3});
    for (const std::uint32_t corner : corners)
      out.put(corner);
  }
  out.flush();
  file.commit();
}

} // namespace pointgi
