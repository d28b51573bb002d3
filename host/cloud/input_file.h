#pragma once
/// Getting hold of a user's input file without being blocked, surprised or drowned by it.
#include "host/error.h"
#include "host/printable.h"
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace pointgi {

/// A whole file in memory.
struct FileBytes {
  std::unique_ptr<char[]> data;
  std::size_t size = 0;
};

/// Throws Error(input) unless `path` is a regular file: a pipe would block, a device never ends.
void require_regular_file(const std::string& path);

/// A regular file that is open for reading at any place; several threads may read at once.
class InputFile {
public:
  /// Throws Error(input) when it is missing, not regular or not readable.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; } ///< bytes, when it was opened

  /// The `bytes` bytes from byte `offset` on, which the file has had when it was opened. Throws Error(input) when it
  /// has become shorter or the disk fails.
  void read(std::uint64_t offset, void* to, std::size_t bytes) const;

private:
  std::string path_;
  std::uint64_t size_ = 0;
  int fd_ = -1;
};

/// Reads a regular file in one go. Throws Error(input) when it is missing, not regular or not readable, and
/// Error(memory) when it is larger than the memory that can be had.
FileBytes read_whole_file(const std::string& path);

/// Whether a file's name ends in `extension` (lower case, with its dot), in whatever case.
bool has_extension(const std::string& path, std::string_view extension);

} // namespace pointgi
