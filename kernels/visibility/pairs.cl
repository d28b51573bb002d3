/* Visibility of all pairs of points, a bit a pair, for the direct solver (method.md section 4). */
#include "visibility/sight.cl"

/* A tile is FMM_LANES x FMM_LANES pairs, FMM_LANES bytes: byte m of the tile (row, column) has bit q set when the points
 * FMM_LANES row + q and FMM_LANES column + m of the table `points` may exchange light and see each other. Each pair is
 * traced once, from the lower index to the higher; its tile's mirror image goes to (column, row).
 * NDRange: 2-D, padded: tiles of columns window.x ... window.x + window.y and rows window.z ... window.z + window.w; those
 * above the diagonal do nothing.
 *   of_rows, of_columns  whole rows of tiles: row `at.x` of the tiles first, at.y tiles a row, the first of them tile at.z.
 *                        A mirror image goes to of_rows where that holds its row, else to of_columns
 *   rays                 grows by the number of rays traced */
__kernel void pairs_visible(SIGHT_PARAMS, const __global OctreePoint* points, uint point_count, uint4 window,
                            __global uchar* of_rows, uint4 rows_at, __global uchar* of_columns, uint4 columns_at,
                            __global uint* rays, float step_delta) {
  const uint column = window.x + get_global_id(0), row = window.z + get_global_id(1);
  if (get_global_id(0) >= window.y || get_global_id(1) >= window.w || column > row)
    return;
  ulong seen = 0ul, mirrored = 0ul;
  uint traced = 0u;
  for (uint m = 0u; m < FMM_LANES; ++m) {
    const uint from = FMM_LANES * column + m;
    for (uint q = column == row ? m + 1u : 0u; q < FMM_LANES; ++q) {
      const uint to = FMM_LANES * row + q;
      if (to >= point_count || !may_exchange(points + from, points + to))
        continue;
      traced += 1u;
      if (sight_blocked(points + from, points + to, step_delta))
        continue;
      seen |= 1ul << (FMM_LANES * m + q);
      mirrored |= 1ul << (FMM_LANES * q + m);
    }
  }
  if (column == row) {
    seen |= mirrored;
    mirrored = seen;
  }
  __global uchar* tile = of_rows + FMM_LANES * ((ulong)(row - rows_at.x) * rows_at.y + column - rows_at.z);
  __global uchar* mirror = column >= rows_at.x
                               ? of_rows + FMM_LANES * ((ulong)(column - rows_at.x) * rows_at.y + row - rows_at.z)
                               : of_columns + FMM_LANES * ((ulong)(column - columns_at.x) * columns_at.y + row - columns_at.z);
  for (uint m = 0u; m < FMM_LANES; ++m) {
    tile[m] = (uchar)(seen >> (FMM_LANES * m));
    mirror[m] = (uchar)(mirrored >> (FMM_LANES * m));
  }
  if (traced != 0u)
    atomic_add(rays, traced);
}
