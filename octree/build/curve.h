#pragma once
/// The curve along which points, leaves and nodes lie in memory, of Morton or of Hilbert.
#include "octree/build/cell_key.h"

namespace pointgi {

/// Which of a cell's children comes when. Both curves leave a cell before they enter the next of its size, so that a
/// cell's points lie together; Hilbert's also enters that next cell through a common face.
enum class PointOrder {
  morton, ///< by child number
  hilbert ///< N = 2 only
};

namespace detail {

constexpr unsigned hilbert_states = 24;

/// How Hilbert's curve runs through a cell in each of its states, after Hamilton and Rau-Chaplin, "Compact Hilbert
/// indices" (2008): it enters at the corner `entry` and leaves along the axis `direction`, state = 3 * entry +
/// direction.
struct HilbertTable {
  std::uint8_t child[hilbert_states][8] = {}; ///< of a place along the curve
  std::uint8_t place[hilbert_states][8] = {}; ///< of a child
  std::uint8_t next[hilbert_states][8] = {};  ///< state inside the child at a place

  constexpr HilbertTable() {
    for (unsigned state = 0; state < hilbert_states; ++state)
      for (unsigned place_in_cell = 0; place_in_cell < 8; ++place_in_cell)
        set(state, place_in_cell);
  }

private:
  static constexpr unsigned gray(unsigned i) { return i ^ (i >> 1); }
  static constexpr unsigned rotate_left(unsigned bits, unsigned by) { return ((bits << by) | (bits >> (3 - by))) & 7u; }
  /// The axis along which the Gray code steps from i to i + 1: the number of ones that i ends in, modulo 3.
  static constexpr unsigned step_axis(unsigned i) { return i % 2 == 0 || i == 7 ? 0 : i % 4 == 1 ? 1 : 2; }

  /// `w`, the paper's name, is the place along the curve.
  constexpr void set(unsigned state, unsigned w) {
    const unsigned entry = state / 3, turn = (state % 3 + 1) % 3;
    const unsigned child_entry = w == 0 ? 0 : gray((w - 1) / 2 * 2);
    const unsigned child_direction = w == 0 ? 0 : w % 2 == 0 ? step_axis(w - 1) : step_axis(w);
    const unsigned c = rotate_left(gray(w), turn) ^ entry;
    child[state][w] = static_cast<std::uint8_t>(c);
    place[state][c] = static_cast<std::uint8_t>(w);
    next[state][w] =
        static_cast<std::uint8_t>(3 * (entry ^ rotate_left(child_entry, turn)) + (state % 3 + child_direction + 1) % 3);
  }
};

inline constexpr HilbertTable hilbert;

} // namespace detail

class Curve {
public:
  /// The root's state; what it means is the curve's own affair.
  static constexpr unsigned start = 0;

  /// Throws std::invalid_argument for Hilbert's order with N = 4.
  Curve(PointOrder order, unsigned axis_bits);

  /// Number of the child at `place` in [0, N³) along the curve, in a cell of this state.
  unsigned child(unsigned state, unsigned place) const {
    return hilbert_ ? detail::hilbert.child[state][place] : place;
  }
  /// The state of that child.
  unsigned next(unsigned state, unsigned place) const { return hilbert_ ? detail::hilbert.next[state][place] : state; }
  /// The key whose digits, from the root down, are the places along the curve; digits as those of cell_key.
  std::uint64_t key(CellCoordinates cell) const {
    return hilbert_ ? hilbert_key(cell) : axis_bits_ == 1 ? morton_key(cell) : cell_key(cell, axis_bits_);
  }

private:
  static std::uint64_t hilbert_key(CellCoordinates cell);

  unsigned axis_bits_;
  bool hilbert_;
};

} // namespace pointgi
