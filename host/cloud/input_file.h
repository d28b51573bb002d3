#pragma once
/// Getting hold of a user's input file without being blocked, surprised or drowned by it.
#include "host/error.h"
#include <cstddef>
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

/// Reads a regular file in one go. Throws Error(input) when it is missing, not regular or not readable, and
/// Error(memory) when it is larger than the memory that can be had.
FileBytes read_whole_file(const std::string& path);

/// Whether a file's name ends in `extension` (lower case, with its dot), in whatever case.
bool has_extension(const std::string& path, std::string_view extension);

/// Text from a file as an error message may show it: in quotes, other than printable ASCII as \xNN, cut after
/// `max_bytes` bytes of the text. Terminals obey escape sequences, so that nothing of a file goes there as it is.
std::string quoted_bytes(std::string_view text, std::size_t max_bytes = 40);

/// As quoted_bytes(), without the quotes.
std::string printable(std::string_view text, std::size_t max_bytes = 40);

} // namespace pointgi
