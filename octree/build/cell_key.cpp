#include "octree/build/cell_key.h"

namespace pointgi {

CellCoordinates cell_of(const float position[3]) {
  constexpr float cells = static_cast<float>(1u << MAX_AXIS_BITS);
  CellCoordinates cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const float scaled = position[axis] * cells;
    // Written so that NaN lands in cell 0 instead of undefined behaviour.
    cell[axis] = scaled >= cells ? (1u << MAX_AXIS_BITS) - 1u : scaled > 0.0f ? static_cast<std::uint32_t>(scaled) : 0u;
  }
  return cell;
}

namespace {

/// Puts two zero bits between any two of the lowest 21 bits.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffffu;
  bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
  return (bits | bits << 2) & 0x1249249249249249u;
}

} // namespace

std::uint64_t cell_key(CellCoordinates cell, unsigned axis_bits) {
  if (axis_bits == 1)
    return spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2; // 63 digits one by one: slow
  const unsigned levels = key_levels(axis_bits);
  const unsigned unused = MAX_AXIS_BITS - levels * axis_bits; // N = 4: 21 bits are ten digits and one bit over
  const std::uint32_t digit_mask = (1u << axis_bits) - 1u;
  std::uint64_t key = 0;
  for (unsigned level = 0; level < levels; ++level) {
    const unsigned shift = unused + axis_bits * (levels - 1 - level);
    for (int axis = 2; axis >= 0; --axis)
      key = (key << axis_bits) | ((cell[axis] >> shift) & digit_mask);
  }
  return key;
}

} // namespace pointgi
