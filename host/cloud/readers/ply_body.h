#pragma once
/// The body of a PLY file as a stream of records of values; one class a kind of body, with the same functions, so that
/// the reader is written once. Every value is a double: it holds each PLY type exactly.
#include "host/cloud/input_file.h"
#include "host/cloud/readers/ply_header.h"
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace pointgi {

/// What the two kinds of body share: where they are in the file, and how they complain.
class PlyBody {
public:
  PlyBody(const PlyHeader& header, const FileBytes& bytes, const std::string& file)
      : file_(file), begin_(bytes.data.get()), at_(begin_ + header.body_offset), end_(begin_ + bytes.size) {}

protected:
  void note_record(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  [[noreturn]] void fail_at(const std::string& place, const std::string& what) const {
    throw Error(ErrorKind::input, file_ + ": " + place + " (" + printable(element_->name) + " " +
                                      std::to_string(index_) + " of " + std::to_string(element_->count) + "): " + what);
  }

  const std::string& file_;
  const char* begin_;
  const char* at_;
  const char* end_;

private:
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0; ///< of the record, from 0
};

/// Values in the bytes of either order.
class PlyBinaryBody : public PlyBody {
public:
  PlyBinaryBody(const PlyHeader& header, const FileBytes& bytes, const std::string& file)
      : PlyBody(header, bytes, file),
        swap_((header.format == PlyFormat::binary_big_endian) != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)) {}

  void begin_record(const PlyElement& element, std::uint64_t index) {
    note_record(element, index);
    record_ = at_;
  }
  void end_record() {}

  double scalar(FieldType type) {
    if (static_cast<std::size_t>(end_ - at_) < size_of(type)) fail("the file ends within a value; it is truncated");
    switch (type) {
    case FieldType::i8:
      return load<std::int8_t, std::uint8_t>();
    case FieldType::u8:
      return load<std::uint8_t, std::uint8_t>();
    case FieldType::i16:
      return load<std::int16_t, std::uint16_t>();
    case FieldType::u16:
      return load<std::uint16_t, std::uint16_t>();
    case FieldType::i32:
      return load<std::int32_t, std::uint32_t>();
    case FieldType::u32:
      return load<std::uint32_t, std::uint32_t>();
    case FieldType::f32:
      return static_cast<double>(load<float, std::uint32_t>());
    case FieldType::f64:
      return load<double, std::uint64_t>();
    case FieldType::i64: // no type of PLY
    case FieldType::u64:
      break;
    }
    return 0.0;
  }

  /// The number of items that follow, checked against the bytes that are left.
  std::size_t list_count(const PlyProperty& list) {
    const char* place = at_;
    const double count = scalar(list.count_type);
    const auto fits = static_cast<double>(static_cast<std::size_t>(end_ - at_) / size_of(list.type));
    if (count < 0 || count > fits) {
      at_ = place;
      fail("the list " + quoted_bytes(list.name) + " announces " + std::to_string(static_cast<long long>(count)) +
           " items, expected 0 to " + std::to_string(static_cast<long long>(fits)) +
           ", which the rest of the file can hold; the file is truncated or corrupt");
    }
    return static_cast<std::size_t>(count);
  }
  void skip(FieldType type, std::size_t items) {
    if (items > static_cast<std::size_t>(end_ - at_) / size_of(type))
      fail("the file ends within a value; it is truncated");
    at_ += items * size_of(type);
  }

  /// What stands after the last record: empty, or a description of it.
  std::string trailing() const {
    if (at_ == end_) return "";
    return std::to_string(end_ - at_) + " bytes from byte " + std::to_string(at_ - begin_) + " on";
  }

  std::string surplus() const { return ""; } ///< bytes have no lines that could be too long

  [[noreturn]] void fail(const std::string& what) const { fail_at("byte " + std::to_string(at_ - begin_), what); }
  [[noreturn]] void fail_record(const std::string& what) const {
    fail_at("byte " + std::to_string(record_ - begin_), what);
  }

private:
  template <class Value, class Bits>
  Value load() {
    Bits bits;
    std::memcpy(&bits, at_, sizeof bits);
    at_ += sizeof bits;
    if (swap_) {
      if constexpr (sizeof bits == 2)
        bits = __builtin_bswap16(bits);
      else if constexpr (sizeof bits == 4)
        bits = __builtin_bswap32(bits);
      else if constexpr (sizeof bits == 8)
        bits = __builtin_bswap64(bits);
    }
    Value value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  bool swap_;
  const char* record_ = nullptr;
};

/// Values in words, a record a line; blank lines don't count. Numbers don't depend on the locale.
class PlyAsciiBody : public PlyBody {
public:
  PlyAsciiBody(const PlyHeader& header, const FileBytes& bytes, const std::string& file)
      : PlyBody(header, bytes, file), line_(header.body_line), next_line_(header.body_line), line_end_(at_) {}

  void begin_record(const PlyElement& element, std::uint64_t index) {
    note_record(element, index);
    if (!next_filled_line()) fail("the file ends here; it is truncated");
  }
  /// Values beyond the declared ones are common (MeshLab declares face colours and writes wedge colours): counted only.
  void end_record() {
    if (at_line_end()) return;
    if (lines_too_long_++ == 0) first_long_line_ = line_;
    at_ = line_end_;
  }

  double scalar(FieldType type) {
    if (at_line_end())
      fail("fewer values than the header declares: expected another one (" + std::string(name_of(type)) + ")");
    const std::string_view text = word();
    const double value = number(text);
    if (!is_float(type)) check_whole(value, type, text);
    return value;
  }

  std::size_t list_count(const PlyProperty& list) {
    const double count = scalar(list.count_type);
    // Each item takes a blank and a digit at least.
    const auto fits = static_cast<double>((line_end_ - at_) / 2);
    if (count < 0 || count > fits)
      fail("the list " + quoted_bytes(list.name) + " announces " + std::to_string(static_cast<long long>(count)) +
           " items, expected 0 to " + std::to_string(static_cast<long long>(fits)) + ", which the line can hold");
    return static_cast<std::size_t>(count);
  }
  /// What nobody uses must be a number, but may break the promise of its type.
  void skip(FieldType, std::size_t items) {
    for (std::size_t i = 0; i < items; ++i)
      (void)scalar(FieldType::f64);
  }

  std::string trailing() {
    if (!next_filled_line()) return "";
    return "text from line " + std::to_string(line_) + " on";
  }

  /// Lines with more values than declared: their number and the first of them, or empty.
  std::string surplus() const {
    if (lines_too_long_ == 0) return "";
    return std::to_string(lines_too_long_) + ", the first is line " + std::to_string(first_long_line_);
  }

  [[noreturn]] void fail(const std::string& what) const { fail_at("line " + std::to_string(line_), what); }
  [[noreturn]] void fail_record(const std::string& what) const { fail(what); }

private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

  bool at_line_end() {
    while (at_ < line_end_ && is_blank(*at_))
      ++at_;
    return at_ == line_end_;
  }

  /// Steps to the next line that has a word. LF, CR and CRLF all end a line here: nothing is ambiguous in text.
  bool next_filled_line() {
    while (true) {
      at_ = line_end_;
      if (started_ && at_ < end_) {
        at_ += (*at_ == '\r' && at_ + 1 < end_ && at_[1] == '\n') ? 2 : 1;
        ++next_line_;
      }
      started_ = true;
      line_ = next_line_;
      if (at_ == end_) {
        line_end_ = end_;
        return false;
      }
      line_end_ = at_;
      while (line_end_ < end_ && *line_end_ != '\n' && *line_end_ != '\r')
        ++line_end_;
      if (!at_line_end()) return true;
    }
  }

  std::string_view word() {
    const char* start = at_;
    while (at_ < line_end_ && !is_blank(*at_))
      ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
  }

  double number(std::string_view text) const {
    const char* first = text.data();
    const char* last = first + text.size();
    if (*first == '+' && text.size() > 1 && first[1] != '-') ++first;
    double value = 0.0;
    const auto [stop, error] = std::from_chars(first, last, value);
    if (stop != last || error == std::errc::invalid_argument)
      fail("expected a number, found " + quoted_bytes(text) +
           (text.find(',') != std::string_view::npos ? "; the decimal sign is a point, and blanks separate values"
                                                     : ""));
    if (error == std::errc::result_out_of_range) {
      // Too small is zero and too large is infinite, as a conversion to float would have it.
      const std::size_t exponent = text.find_first_of("eE");
      const bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() && text[exponent + 1] == '-';
      value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
      return *first == '-' ? -value : value;
    }
    return value;
  }

  void check_whole(double value, FieldType type, std::string_view text) const {
    const int bits = static_cast<int>(8 * size_of(type));
    const bool is_signed = type == FieldType::i8 || type == FieldType::i16 || type == FieldType::i32;
    const double low = is_signed ? -std::ldexp(1.0, bits - 1) : 0.0;
    const double high = std::ldexp(1.0, is_signed ? bits - 1 : bits) - 1.0;
    if (!(value >= low && value <= high) || value != std::floor(value))
      fail("expected a whole number from " + std::to_string(static_cast<long long>(low)) + " to " +
           std::to_string(static_cast<long long>(high)) + " (" + name_of(type) + "), found " + quoted_bytes(text));
  }

  std::size_t line_;
  std::size_t next_line_;
  const char* line_end_;
  bool started_ = false;
  std::size_t lines_too_long_ = 0;
  std::size_t first_long_line_ = 0;
};

} // namespace pointgi
