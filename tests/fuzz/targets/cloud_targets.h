#pragma once
/// The readers of clouds that are fuzzed, for the targets and for those who write their corpora.
#include "tests/fuzz/cloud_seeds.h"
#include <string_view>

namespace pointgi::test {

struct CloudTarget {
  const char* name;   ///< of the program, behind fuzz_
  const char* format; ///< of the row of cloud_readers() whose reader it calls
  /// The bytes are packed as the format has it before they are read: no mutation would have the right checksums.
  bool inside;
};

inline constexpr CloudTarget cloud_targets[] = {
    {"ply", "PLY", false},   {"compressed_ply", "compressed PLY of Gaussians", false},
    {"las", "LAS", false}, // reads LAZ, too
    {"e57", "E57", false},   {"e57_inside", "E57", true},
    {"pcd", "PCD", false},   {"ptx", "PTX", false},
    {"text", "text", false}, {"splat", "splat", false},
    {"spz", "SPZ", false},   {"spz_inside", "SPZ", true},
};

} // namespace pointgi::test
