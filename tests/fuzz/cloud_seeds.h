#pragma once
/// Small sound files of every format that is read, to be damaged.
#include <functional>
#include <string>
#include <vector>

namespace pointgi::test {

/// Where a file says how many of something follow.
struct CountPlace {
  std::size_t byte = 0;
  std::size_t bytes = 0; ///< of a binary number, or of its digits
  bool digits = false;
};

struct CloudSeed {
  std::string format;    ///< of the row of cloud_readers() that reads it
  std::string extension; ///< ".ply"
  std::string bytes;
  std::size_t points = 0;         ///< of the sound file
  std::string end_of_header = ""; ///< text before which words and numbers stand; empty: no such text
  std::vector<CountPlace> counts;
  std::size_t expansion = 1; ///< bytes that a byte of the file can stand for at most
  /// Packs the bytes as the file has them; null: they are the file.
  std::function<std::string(const std::string&)> pack = nullptr;
};

/// At least one for every row of cloud_readers() that is read.
std::vector<CloudSeed> cloud_seeds();

} // namespace pointgi::test
