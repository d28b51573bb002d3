#pragma once
/// Values on their way into a binary file.
#include "host/atomic_file.h"
#include "host/cloud/field.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

namespace pointgi {

/// A number as an integer type holds it: rounded, at the ends of the type where it lies beyond, 0 where it is none.
template <class Integer>
Integer nearest_integer(double value) {
  constexpr double low = static_cast<double>(std::numeric_limits<Integer>::min());
  constexpr double high = static_cast<double>(std::numeric_limits<Integer>::max()); // of 64 bits the next power of two
  if (std::isnan(value)) return 0;
  const double whole = std::round(value);
  if (whole <= low) return std::numeric_limits<Integer>::min();
  if (whole >= high) return std::numeric_limits<Integer>::max();
  return static_cast<Integer>(whole);
}

/// Collects values in the byte order of the file and hands them on in large pieces.
class ByteStream {
public:
  /// `file` outlives this. `big_endian`: of the file, not of the machine.
  explicit ByteStream(AtomicFile& file, bool big_endian = false)
      : file_(file), swap_(big_endian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)) {
    buffer_.reserve(capacity);
  }

  void text(std::string_view words) { bytes(words.data(), words.size()); }

  /// As they are.
  void bytes(const char* data, std::size_t count) {
    if (buffer_.size() + count > capacity) flush();
    if (count > capacity)
      file_.write(data, count);
    else
      buffer_.insert(buffer_.end(), data, data + count);
  }

  template <class Value>
  void put(Value value) {
    char data[sizeof value];
    std::memcpy(data, &value, sizeof value);
    if (swap_) std::reverse(data, data + sizeof value);
    bytes(data, sizeof value);
  }

  /// The value in this type; integers as nearest_integer.
  void put(double value, FieldType type) {
    switch (type) {
    case FieldType::i8:
      return put(nearest_integer<std::int8_t>(value));
    case FieldType::u8:
      return put(nearest_integer<std::uint8_t>(value));
    case FieldType::i16:
      return put(nearest_integer<std::int16_t>(value));
    case FieldType::u16:
      return put(nearest_integer<std::uint16_t>(value));
    case FieldType::i32:
      return put(nearest_integer<std::int32_t>(value));
    case FieldType::u32:
      return put(nearest_integer<std::uint32_t>(value));
    case FieldType::i64:
      return put(nearest_integer<std::int64_t>(value));
    case FieldType::u64:
      return put(nearest_integer<std::uint64_t>(value));
    case FieldType::f32:
      return put(static_cast<float>(value));
    case FieldType::f64:
      return put(value);
    }
  }

  void flush() {
    file_.write(buffer_.data(), buffer_.size());
    buffer_.clear();
  }

private:
  static constexpr std::size_t capacity = 1 << 20;

  AtomicFile& file_;
  bool swap_;
  std::vector<char> buffer_;
};

} // namespace pointgi
