#pragma once
/// A value that a file has for each of its points: PLY calls it a property, LAS a dimension, PCD a field, a table a
/// column.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pointgi {

enum class FieldType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

inline bool is_float(FieldType type) {
  return type == FieldType::f32 || type == FieldType::f64;
}
/// Bytes of one value in a binary file.
std::size_t size_of(FieldType type);
/// As PLY calls it: "uchar", "float" ...; "int64" and "uint64", which PLY lacks.
const char* name_of(FieldType type);

/// What a file says of one of its fields.
struct FieldInfo {
  std::string name;
  FieldType type = FieldType::f32;
  double scale = 1.0; ///< the file holds (value - offset) / scale, as LAS does; values are given with both applied
  double offset = 0.0;
};

/// One field of all points. A double holds every type but integers above 2^53 exactly.
struct Field {
  FieldInfo info;
  std::vector<double> values; ///< one a point
};

/// A name as fields are looked up by it: in lower case, without the scalar_ that CloudCompare puts before its own.
std::string lookup_name(const std::string& name);
/// The first field whose lookup name is that of `name`, or null.
const Field* find_field(const std::vector<Field>& fields, const std::string& name);

} // namespace pointgi
