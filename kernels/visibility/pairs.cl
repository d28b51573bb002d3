/* Visibility of all pairs of points, a bit a pair, for the direct solver (method.md section 4). */
#include "lib/pair_tiles.cl"
#include "visibility/sight.cl"

/* Tiles of the table `points` (PairRows), each pair by one ray, from the lower index to the higher.
 * NDRange: 2-D, padded: at.columns x at.rows tiles of the band; those above the diagonal do nothing.
 *   tiles  of the band
 *   rays   grows by the number of rays traced */
__kernel OWN_VECTORS void pairs_visible(SIGHT_PARAMS, const __global OctreePoint* points, PairRows at, __global ulong* tiles,
                            __global uint* rays) {
  const uint column = at.first_column + get_global_id(0), row = at.first_row + get_global_id(1);
  if (get_global_id(0) >= at.columns || get_global_id(1) >= at.rows || column > row)
    return;
  ulong seen = 0ul;
  uint traced = 0u;
  for (uint m = 0u; m < FMM_LANES; ++m) {
    const uint from = FMM_LANES * column + m;
    for (uint q = column == row ? m + 1u : 0u; q < FMM_LANES; ++q) {
      const uint to = FMM_LANES * row + q;
      if (to >= at.points || !may_exchange(points + from, points + to))
        continue;
      traced += 1u;
      seen |= sight_blocked(points + from, points + to, at.step_delta) ? 0ul : 1ul << (FMM_LANES * m + q);
    }
  }
  if (column == row)
    seen |= mirrored_tile(seen);
  const ulong before = PAIR_TILES(at.held_from / SQUARE_TILES);
  tiles[PAIR_TILE(row, column) - before] = seen;
  if (column / SQUARE_TILES == row / SQUARE_TILES)
    tiles[PAIR_TILE(column, row) - before] = mirrored_tile(seen);
  if (traced != 0u)
    atomic_add(rays, traced);
}
