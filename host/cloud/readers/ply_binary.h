#pragma once
/// The body of a binary PLY file. Every value is a double: it holds each PLY type exactly.
#include "host/cloud/input_file.h"
#include "host/cloud/readers/ply_header.h"
#include "host/cloud/readers/point_sink.h"
#include <memory>

namespace pointgi {

/// The value at `bytes`, little-endian, or big-endian where `swap` says so.
double ply_value(const char* bytes, FieldType type, bool swap);

/// A stream of records of values, through a window on the file; and points of one length past it, on all cores.
class PlyBinaryBody {
public:
  PlyBinaryBody(const PlyHeader& header, const InputFile& file);

  void begin_record(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
    record_ = position();
  }
  void end_record() {}

  double scalar(FieldType type) {
    const std::size_t bytes = size_of(type);
    if (static_cast<std::size_t>(end_ - at_) < bytes) move_window(bytes);
    const double value = ply_value(at_, type, swap_);
    at_ += bytes;
    return value;
  }
  /// The number of items that follow, checked against the bytes that are left.
  std::size_t list_count(const PlyProperty& list);
  void skip(FieldType type, std::size_t items);

  /// Reads all records of the element into the sink, or skips them; false, with nothing done, where they differ in
  /// length.
  bool read_points(const PlyElement& vertex, const FieldPlan& plan, PointSink& sink);
  bool skip_element(const PlyElement& element);

  /// What stands after the last record: empty, or a description of it.
  std::string trailing() const;
  std::string surplus() const { return ""; } ///< bytes have no lines that could be too long

  [[noreturn]] void fail(const std::string& what) const { fail_at(position(), what); }
  [[noreturn]] void fail_record(const std::string& what) const { fail_at(record_, what); }

private:
  std::uint64_t position() const { return window_begin_ + static_cast<std::uint64_t>(at_ - window_.get()); }
  std::uint64_t left() const { return file_.size() - position(); }
  /// Makes the window begin where the body is; fails where the file has not as many bytes more.
  void move_window(std::size_t bytes);
  void go_to(std::uint64_t position);
  /// Bytes of all records, which the file has; 0: they have lists.
  std::uint64_t size_of_records(const PlyElement& element);
  [[noreturn]] void fail_at(std::uint64_t byte, const std::string& what) const;

  const InputFile& file_;
  bool swap_;
  std::unique_ptr<char[]> window_;
  std::uint64_t window_begin_; ///< byte of the file
  const char* at_;
  const char* end_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;  ///< of the record, from 0
  std::uint64_t record_ = 0; ///< byte at which it begins
};

} // namespace pointgi
