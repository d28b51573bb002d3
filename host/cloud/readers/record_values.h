#pragma once
/// Little-endian values in records of bytes, as LAS and PCD have them.
#include "host/cloud/field.h"
#include <cstdint>
#include <cstring>

namespace pointgi {

template <class Value>
Value little_endian(const char* bytes) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they lie in the file");
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// The value that begins at `bytes`, as it is stored: no scale, no offset.
inline double value_at(const char* bytes, FieldType type) {
  switch (type) {
  case FieldType::i8:
    return little_endian<std::int8_t>(bytes);
  case FieldType::u8:
    return little_endian<std::uint8_t>(bytes);
  case FieldType::i16:
    return little_endian<std::int16_t>(bytes);
  case FieldType::u16:
    return little_endian<std::uint16_t>(bytes);
  case FieldType::i32:
    return little_endian<std::int32_t>(bytes);
  case FieldType::u32:
    return little_endian<std::uint32_t>(bytes);
  case FieldType::i64:
    return static_cast<double>(little_endian<std::int64_t>(bytes));
  case FieldType::u64:
    return static_cast<double>(little_endian<std::uint64_t>(bytes));
  case FieldType::f32:
    return static_cast<double>(little_endian<float>(bytes));
  case FieldType::f64:
    break;
  }
  return little_endian<double>(bytes);
}

} // namespace pointgi
