#pragma once
/// The outer layer of an E57 file (ASTM E2807): pages of which each ends in a checksum.
#include "host/cloud/input_file.h"
#include <vector>

namespace pointgi {

/// Whether the first bytes of a file are those of an E57 file.
bool is_e57(const char* data, std::size_t size);

/// A place is a logical byte: one that counts the pages' contents only.
class E57File {
public:
  /// Throws Error(input) naming the byte: no E57 file, another version, pages of an impossible size, a file shorter
  /// than it says.
  explicit E57File(const std::string& path);

  const std::string& path() const { return file_.path(); }
  std::uint64_t bytes() const { return logical_bytes_; } ///< logical ones of the whole file
  std::uint64_t xml_begin() const { return xml_begin_; }
  std::uint64_t xml_bytes() const { return xml_bytes_; } ///< the file has them

  /// The logical byte of a byte of the file. Throws Error(input) where it is a checksum's, or behind the end;
  /// `what` is there.
  std::uint64_t logical(std::uint64_t physical, const std::string& what) const;

  /// Logical bytes. Throws Error(input) when they go beyond the end, or a page's checksum is wrong.
  void read(std::uint64_t begin, void* to, std::uint64_t count) const;
  std::vector<char> read(std::uint64_t begin, std::uint64_t count) const;

  /// `place`: a logical byte; the message names the byte of the file.
  [[noreturn]] void fail(std::uint64_t place, const std::string& what) const;

private:
  InputFile file_;
  std::uint64_t page_bytes_ = 1024;
  std::uint64_t content_bytes_ = 1020; ///< of a page
  std::uint64_t logical_bytes_ = 0;
  std::uint64_t xml_begin_ = 0;
  std::uint64_t xml_bytes_ = 0;
};

} // namespace pointgi
