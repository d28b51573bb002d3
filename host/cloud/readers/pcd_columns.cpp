#include "host/cloud/readers/pcd_columns.h"
#include <cmath>

namespace pointgi {

namespace {

constexpr std::size_t most_values = 16;

/// What a field of several values holds, if its name tells; else they are numbered.
std::string value_name(const PcdField& field, std::size_t k) {
  static const std::vector<std::pair<const char*, std::vector<const char*>>> known{
      {"xyz", {"x", "y", "z"}},
      {"normal", {"normal_x", "normal_y", "normal_z"}},
      {"rgb", {"red", "green", "blue"}},
      {"rgba", {"red", "green", "blue", "alpha"}}};
  if (field.values == 1) return field.name;
  for (const auto& [name, parts] : known)
    if (field.name == name && field.values == parts.size()) return parts[k];
  return field.name + std::to_string(k);
}

} // namespace

std::vector<PcdColumn> pcd_columns(const PcdHeader& header) {
  std::vector<PcdColumn> columns;
  std::size_t place = 0, begin = 0;
  for (const PcdField& field : header.fields) {
    const bool is_used = field.name != "_" && field.values <= most_values;
    for (std::size_t k = 0; is_used && k < field.values; ++k) {
      PcdColumn& column = columns.emplace_back();
      column.info.name = value_name(field, k);
      column.info.type = field.type;
      column.place = place + k;
      column.field_begin = begin;
      column.field_bytes = field.bytes();
      column.byte = k * size_of(field.type);
      column.packs_in_float = field.type == FieldType::f32 && (column.info.name == "rgb" || column.info.name == "rgba");
      if (column.packs_in_float) column.info.type = FieldType::u32;
    }
    place += field.values;
    begin += field.bytes();
  }
  return columns;
}

double packed_in_text(double value) {
  if (value >= 1.0 && value <= 4294967295.0 && value == std::floor(value)) return value;
  const auto narrow = static_cast<float>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &narrow, sizeof bits);
  return bits;
}

} // namespace pointgi
