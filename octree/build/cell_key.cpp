#include "octree/build/cell_key.h"

namespace pointgi {

std::uint64_t cell_key(CellCoordinates cell, unsigned axis_bits) {
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
