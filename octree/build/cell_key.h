#pragma once
/// Space-filling order of the cells of an N^d tree.
#include "shared/octree_types.h"
#include <array>
#include <cstdint>

namespace pointgi {

/// Integer cell coordinates at the finest level, one an axis, in [0, 2^MAX_AXIS_BITS).
using CellCoordinates = std::array<std::uint32_t, 3>;

/// int(p * 2^MAX_AXIS_BITS) per axis; p is clamped to [0,1), so that rounding at the upper face stays inside.
CellCoordinates cell_of(const float position[3]);

/// The key whose digits, from the root down, are the child numbers x + N*y + N*N*z of method.md §2: for N = 2 it is
/// Morton's order. `axis_bits` is log2 N (1 or 2); levels = floor(MAX_AXIS_BITS / axis_bits) digits of 3*axis_bits
/// bits, right-aligned.
std::uint64_t cell_key(CellCoordinates cell, unsigned axis_bits);

/// Number of levels below the root that a key tells apart.
constexpr unsigned key_levels(unsigned axis_bits) {
  return MAX_AXIS_BITS / axis_bits;
}

} // namespace pointgi
