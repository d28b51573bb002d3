#include "host/atomic_file.h"
#include "host/cloud/readers/ply.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pointgi {

namespace {

/// Collects values in the little-endian order of the file and hands them on in large pieces.
class LittleEndianStream {
public:
  explicit LittleEndianStream(AtomicFile& file) : file_(file) { buffer_.reserve(capacity); }

  void text(const std::string& words) { append(words.data(), words.size()); }
  void put(std::uint8_t value) { append(&value, 1); }
  void put(std::uint32_t value) {
    const std::uint8_t bytes[4] = {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
                                   static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 24)};
    append(bytes, sizeof bytes);
  }
  void put(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    put(bits);
  }
  void put(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    put(static_cast<std::uint32_t>(bits));
    put(static_cast<std::uint32_t>(bits >> 32));
  }
  void flush() {
    file_.write(buffer_.data(), buffer_.size());
    buffer_.clear();
  }

private:
  static constexpr std::size_t capacity = 1 << 20;

  void append(const void* data, std::size_t bytes) {
    if (buffer_.size() + bytes > capacity) flush();
    const char* from = static_cast<const char*>(data);
    buffer_.insert(buffer_.end(), from, from + bytes);
  }

  AtomicFile& file_;
  std::vector<char> buffer_;
};

/// A colour channel as the usual byte; what is no number becomes black.
std::uint8_t to_byte(float channel) {
  return std::isnan(channel) ? std::uint8_t{0}
                             : static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0f, 1.0f) * 255.0f));
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
  LittleEndianStream out(file);
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
