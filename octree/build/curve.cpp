#include "octree/build/curve.h"
#include <stdexcept>

namespace pointgi {

Curve::Curve(PointOrder order, unsigned axis_bits) : axis_bits_(axis_bits), hilbert_(order == PointOrder::hilbert) {
  if (hilbert_ && axis_bits != 1) throw std::invalid_argument("octree: Hilbert's order is there for N = 2 only");
}

std::uint64_t Curve::hilbert_key(CellCoordinates cell) {
  const std::uint64_t children = morton_key(cell);
  std::uint64_t key = 0;
  unsigned state = start;
  for (unsigned level = key_levels(1); level-- > 0;) {
    const unsigned place = detail::hilbert.place[state][(children >> (3 * level)) & 7u];
    key = (key << 3) | place;
    state = detail::hilbert.next[state][place];
  }
  return key;
}

} // namespace pointgi
