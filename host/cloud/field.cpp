#include "host/cloud/field.h"
#include <algorithm>

namespace pointgi {

std::size_t size_of(FieldType type) {
  switch (type) {
  case FieldType::i8:
  case FieldType::u8:
    return 1;
  case FieldType::i16:
  case FieldType::u16:
    return 2;
  case FieldType::i32:
  case FieldType::u32:
  case FieldType::f32:
    return 4;
  case FieldType::i64:
  case FieldType::u64:
  case FieldType::f64:
    return 8;
  }
  return 0;
}

const char* name_of(FieldType type) {
  switch (type) {
  case FieldType::i8:
    return "char";
  case FieldType::u8:
    return "uchar";
  case FieldType::i16:
    return "short";
  case FieldType::u16:
    return "ushort";
  case FieldType::i32:
    return "int";
  case FieldType::u32:
    return "uint";
  case FieldType::i64:
    return "int64";
  case FieldType::u64:
    return "uint64";
  case FieldType::f32:
    return "float";
  case FieldType::f64:
    return "double";
  }
  return "unknown";
}

std::string lookup_name(const std::string& name) {
  std::string lower = name;
  // By hand: std::tolower depends on the locale.
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const std::string prefix = "scalar_";
  const bool prefixed = lower.size() > prefix.size() && lower.compare(0, prefix.size(), prefix) == 0;
  return prefixed ? lower.substr(prefix.size()) : lower;
}

const Field* find_field(const std::vector<Field>& fields, const std::string& name) {
  const std::string wanted = lookup_name(name);
  const auto at = std::find_if(fields.begin(), fields.end(),
                               [&](const Field& field) { return lookup_name(field.info.name) == wanted; });
  return at == fields.end() ? nullptr : &*at;
}

} // namespace pointgi
