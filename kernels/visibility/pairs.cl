/* Visibility of all pairs of points, a bit a pair, for the direct solver (method.md section 4). */
#include "shared/fmm_types.h"
#include "visibility/segment.cl"

/* Whether one of the two may give the other anything: they face each other, or, where a source is so close that it is
 * four quarters of its disc (FMM_CLOSE), its middle at least does not hide behind its own side. */
static inline bool may_exchange(const __global OctreePoint* a, const __global OctreePoint* b) {
  const float3 r = load3(b->position) - load3(a->position);
  const float before_a = dot3(load3(a->normal), r), before_b = -dot3(load3(b->normal), r), r2 = dot3(r, r);
  return before_a > 0.0f ? before_b > 0.0f || r2 < FMM_CLOSE * a->area : before_b > 0.0f && r2 < FMM_CLOSE * b->area;
}

/* A tile is FMM_LANES x FMM_LANES pairs, FMM_LANES bytes: byte m of the tile (row, column) has bit q set when the points
 * FMM_LANES row + q and FMM_LANES column + m of the table `points` may exchange light and see each other. Each pair is
 * traced once, from the lower index to the higher; its tile's mirror image goes to (column, row).
 * NDRange: 2-D, padded: tiles of columns window.x ... window.x + window.y and rows window.z ... window.z + window.w; those
 * above the diagonal do nothing.
 *   of_rows, of_columns  hold whole rows of tiles, `tiles` long, the first of them row held.x and row held.y; one
 *                        buffer where window's rows and columns lie in the same
 *   rays                 grows by the number of rays traced */
__kernel void pairs_visible(POOL_PARAMS, const __global OctreePoint* points, uint point_count, uint4 window,
                            __global uchar* of_rows, __global uchar* of_columns, uint2 held, uint tiles,
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
      if (segment_blocked(POOL_ARGS, points + from, points + to, step_delta))
        continue;
      seen |= 1ul << (FMM_LANES * m + q);
      mirrored |= 1ul << (FMM_LANES * q + m);
    }
  }
  if (column == row) {
    seen |= mirrored;
    mirrored = seen;
  }
  __global uchar* tile = of_rows + FMM_LANES * ((ulong)(row - held.x) * tiles + column);
  __global uchar* mirror = of_columns + FMM_LANES * ((ulong)(column - held.y) * tiles + row);
  for (uint m = 0u; m < FMM_LANES; ++m) {
    tile[m] = (uchar)(seen >> (FMM_LANES * m));
    mirror[m] = (uchar)(mirrored >> (FMM_LANES * m));
  }
  if (traced != 0u)
    atomic_add(rays, traced);
}
