#pragma once
/// The header of a PCD file (Point Cloud Library), versions .5 to .7.
#include "host/cloud/field.h"
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace pointgi {

enum class PcdData { ascii, binary, binary_compressed };
const char* name_of(PcdData data);

/// One of FIELDS: so many values of a type one behind the other.
struct PcdField {
  std::string name;
  FieldType type = FieldType::f32;
  std::size_t values = 1;
  std::size_t bytes() const { return values * size_of(type); }
};

/// VIEWPOINT: where the sensor was, in the coordinates of the points.
struct PcdViewpoint {
  Eigen::Vector3d position;
  Eigen::Quaterniond turn;
};

struct PcdHeader {
  PcdData data = PcdData::ascii;
  std::vector<PcdField> fields;
  std::uint64_t width = 0, height = 0; ///< pixels of an organised cloud; height 1: a list
  std::uint64_t points = 0;            ///< at least 1
  std::size_t points_line = 0;         ///< line that says how many
  std::optional<PcdViewpoint> viewpoint;
  std::size_t body = 0;      ///< byte behind the line DATA
  std::size_t body_line = 0; ///< number of the line that begins there
  std::vector<std::string> warnings;

  std::uint64_t record_bytes() const; ///< of a point in a binary file
};

/// Whether the first bytes of a file are those of a PCD header.
bool is_pcd(const char* data, std::size_t size);

/// Reads the header from the first bytes of a file, `size` of `file_bytes`. The points are known to fit into the file:
/// a byte of text for each value, all bytes of a binary one, and what the compression could make of the file at most.
/// Throws Error(input) "<file>: line N: …".
PcdHeader parse_pcd_header(const char* data, std::size_t size, std::uint64_t file_bytes, const std::string& file);

} // namespace pointgi
