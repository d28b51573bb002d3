#pragma once
/// Space-filling order of the cells of an N^d tree.
#include "shared/octree_types.h"
#include <array>
#include <cstdint>

namespace pointgi {

/// Integer cell coordinates at the finest level, one an axis, in [0, 2^MAX_AXIS_BITS).
using CellCoordinates = std::array<std::uint32_t, 3>;

/// int(p * 2^MAX_AXIS_BITS) per axis; p is clamped to [0,1), so that rounding at the upper face stays inside.
inline CellCoordinates cell_of(const float position[3]) {
  constexpr float cells = static_cast<float>(1u << MAX_AXIS_BITS);
  CellCoordinates cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const float scaled = position[axis] * cells;
    // Written so that NaN lands in cell 0 instead of undefined behaviour.
    cell[axis] = scaled >= cells ? (1u << MAX_AXIS_BITS) - 1u : scaled > 0.0f ? static_cast<std::uint32_t>(scaled) : 0u;
  }
  return cell;
}

/// The key whose digits, from the root down, are the child numbers x + N*y + N*N*z of method.md §2: for N = 2 it is
/// Morton's order. `axis_bits` is log2 N (1 or 2); levels = floor(MAX_AXIS_BITS / axis_bits) digits of 3*axis_bits
/// bits, right-aligned.
std::uint64_t cell_key(CellCoordinates cell, unsigned axis_bits);

/// The same for N = 2, without a loop over the digits.
inline std::uint64_t morton_key(CellCoordinates cell) {
  // Puts two zero bits between any two of the lowest 21 bits.
  const auto spread = [](std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x001f00000000ffffu;
    bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
    return (bits | bits << 2) & 0x1249249249249249u;
  };
  return spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2;
}

/// Number of levels below the root that a key tells apart.
constexpr unsigned key_levels(unsigned axis_bits) {
  return MAX_AXIS_BITS / axis_bits;
}

} // namespace pointgi
