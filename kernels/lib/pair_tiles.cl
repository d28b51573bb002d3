/* Tiles of pairs of points (shared/pair_types.h). */
#include "shared/pair_types.h"
#if FMM_LANES != 8
#error "tiles are 8 x 8 bits, a ulong"
#endif

/* The tile (column, row) of the tile (row, column): bit FMM_LANES m + q goes to FMM_LANES q + m. Across the diagonal change
 * places the single bits of each 2 x 2, then the 2 x 2 of each 4 x 4, then the 4 x 4. */
static inline ulong mirrored_tile(ulong tile) {
  ulong t = (tile ^ (tile >> 7)) & 0x00aa00aa00aa00aaul;
  tile ^= t ^ (t << 7);
  t = (tile ^ (tile >> 14)) & 0x0000cccc0000ccccul;
  tile ^= t ^ (t << 14);
  t = (tile ^ (tile >> 28)) & 0x00000000f0f0f0f0ul;
  return tile ^ t ^ (t << 28);
}
