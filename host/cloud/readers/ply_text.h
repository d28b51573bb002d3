#pragma once
/// The body of an ascii PLY file: values in words, a record a line; blank lines don't count. Numbers don't depend on
/// the locale.
#include "host/cloud/input_file.h"
#include "host/cloud/readers/ply_header.h"
#include "host/cloud/readers/point_sink.h"
#include <memory>
#include <string_view>

namespace pointgi {

/// Lines with more values than their record takes.
struct PlySurplus {
  std::size_t lines = 0;
  std::size_t first_line = 0;
  void add(const PlySurplus& later);
};

/// Records of whole lines in memory. LF, CR and CRLF all end a line here: nothing is ambiguous in text.
class PlyTextRecords {
public:
  PlyTextRecords(const std::string& file, const char* begin, const char* end, std::size_t first_line)
      : file_(&file), at_(begin), line_end_(begin), rest_(begin), end_(end), line_(first_line), next_line_(first_line) {
  }

  /// Steps to the next line that has a word; false where there is none.
  bool next();
  /// What complaints about the line say that it is.
  void name_record(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  /// Values beyond the declared ones are common (MeshLab declares face colours and writes wedge colours): counted only.
  void end_record();

  double scalar(FieldType type);
  /// The number of items that follow, checked against what is left of the line.
  std::size_t list_count(const PlyProperty& list);
  /// What nobody uses must be a number, but may break the promise of its type.
  void skip(FieldType type, std::size_t items);

  const char* rest() const { return rest_; } ///< where the line after this one begins
  const char* end() const { return end_; }
  std::size_t line() const { return line_; } ///< number of this one; after the last, that of the next
  std::size_t next_line() const { return next_line_; }
  const PlySurplus& surplus() const { return surplus_; }

  [[noreturn]] void fail(const std::string& what) const;

private:
  void find_line_end();
  bool at_line_end();
  std::string_view word();
  double number(std::string_view text) const;
  void check_whole(double value, FieldType type, std::string_view text) const;

  const std::string* file_;
  const char* at_;
  const char* line_end_;
  const char* rest_;
  const char* end_;
  const char* line_feed_ = nullptr; ///< the first from `at_` on, or the end; else not known yet
  std::size_t line_;
  std::size_t next_line_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0; ///< of the record, from 0
  PlySurplus surplus_;
};

/// A stream of records, through blocks of whole lines; the points of a block on all cores.
class PlyAsciiBody {
public:
  PlyAsciiBody(const PlyHeader& header, const InputFile& file);

  void begin_record(const PlyElement& element, std::uint64_t index);
  void end_record() { records_.end_record(); }
  double scalar(FieldType type) { return records_.scalar(type); }
  std::size_t list_count(const PlyProperty& list) { return records_.list_count(list); }
  void skip(FieldType type, std::size_t items) { records_.skip(type, items); }

  bool read_points(const PlyElement& vertex, const FieldPlan& plan, PointSink& sink);
  bool skip_element(const PlyElement&) { return false; }

  /// What stands after the last record: empty, or a description of it.
  std::string trailing();
  /// Lines with more values than declared: their number and the first of them, or empty.
  std::string surplus() const;

  [[noreturn]] void fail_record(const std::string& what) const { records_.fail(what); }

private:
  /// Takes the next whole lines of the file into memory; false where it has ended.
  bool load_block();
  /// Steps to the next line that has a word; false where there is none in the file.
  bool next_line();
  std::uint64_t read_block(const PlyElement& vertex, const FieldPlan& plan, std::uint64_t first, PointSink& sink);
  void start(const char* begin, const char* end, std::size_t first_line);

  const InputFile& file_;
  std::uint64_t next_block_; ///< byte of the file
  std::unique_ptr<char[]> block_;
  std::size_t capacity_ = 0;
  PlySurplus surplus_; ///< of the lines before records_
  PlyTextRecords records_;
};

} // namespace pointgi
