#pragma once
/// PLY files with results for each of their points.
#include "host/cloud/field.h"
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace pointgi {

/// A value for each point, asked for as it is written.
struct PointColumn {
  std::string name; ///< without blanks
  FieldType type = FieldType::f32;
  std::function<double(std::size_t point)> value;
};

/// Writes a binary_little_endian PLY of `count` points that have these columns, in their order. 64-bit integers, which
/// PLY lacks, become doubles. Atomic. Throws Error(output).
void write_ply_columns(const std::string& path, std::size_t count, const std::vector<PointColumn>& columns);

/// Writes the PLY file `source` again as `output`, with `columns` behind the properties of each vertex. The rest stays
/// as it is, byte for byte: the format, comments, values, lists, all other elements. (Of ascii files the blanks between
/// the values of a vertex become one, and values beyond those declared go.) A property that has a column's name gives
/// way to the column; where `kept_as` has that name the property stays under the name there, unless the file has one of
/// that name, too. Atomic. Throws Error(input) when the source is no PLY file, holds no vertices or ends too early,
/// Error(output).
void write_ply_with_columns(const std::string& source, const std::string& output,
                            const std::vector<PointColumn>& columns,
                            const std::map<std::string, std::string>& kept_as = {});

/// The names of the properties of a PLY file's vertices that are single numbers. Throws Error(input).
std::vector<std::string> ply_vertex_properties(const std::string& path);

} // namespace pointgi
