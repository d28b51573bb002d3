#pragma once
/// Damaged copies of a file, each given to its reader.
#include "tests/support/mutator.h"
#include "tests/support/survives.h"

namespace pointgi::test {

using ReadFunction = PointCloud (*)(const std::string& path, const ReadRequest& request, CloudReport& report);

/// Reads every beginning of the seed, all of them up to 100 bytes and then about a hundred. Returns how many were
/// clouds.
inline std::size_t count_clouds_of_truncations(ReadFunction read, const std::string& seed, double point_bytes) {
  const TemporaryFolder folder;
  std::size_t clouds = 0;
  for (std::size_t length = 0; length < seed.size(); length += length < 100 ? 1 : 1 + seed.size() / 100) {
    INFO("length " << length);
    clouds += survives(read, folder.write("cut", seed.substr(0, length)), length, point_bytes);
  }
  return clouds;
}

/// Reads `count` damaged copies of the seed. Returns how many were clouds.
inline std::size_t count_clouds_of_mutations(ReadFunction read, const std::string& seed, double point_bytes,
                                             std::uint32_t count, const std::string& end_of_header = "\xff\xff") {
  const TemporaryFolder folder;
  std::size_t clouds = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    INFO("mutation " << i);
    const std::string bytes = Mutator(i, end_of_header)(seed);
    clouds += survives(read, folder.write("mutated", bytes), bytes.size(), point_bytes);
  }
  return clouds;
}

} // namespace pointgi::test
