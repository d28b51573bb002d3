#pragma once
#include <cstdint>

namespace pointgi {

/// 64 bits of which the upper half depend on all bits of the number: numbers that follow each other get bits as if
/// drawn.
inline std::uint64_t mixed_bits(std::uint64_t number) {
  std::uint64_t h = (number + 1) * 0x9E3779B97F4A7C15ull;
  h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9ull;
  return h ^ (h >> 32);
}

/// A number of [0, 1) that a whole number stands for.
inline double uniform_of(std::uint64_t number) {
  return static_cast<double>(mixed_bits(number) >> 11) * 0x1p-53;
}

} // namespace pointgi
