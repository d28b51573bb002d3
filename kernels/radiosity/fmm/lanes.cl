/* Blocks of FMM_LANES nodes or points, as vectors of the language: CPU compilers do not vectorise diverging work-items. */
#include "shared/fmm_types.h"

typedef float8 fmm_lanes;
typedef int8 fmm_mask;
#define load_fmm(p) vload8(0, p)
#define store_fmm(v, p) vstore8(v, 0, p)
#define FMM_LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))

static inline bool fmm_any(fmm_mask m) {
  return (as_ulong(convert_char8(m)) & 0x8080808080808080ul) != 0ul; /* true is -1 */
}

#define INVERSE_PI 0.318309886f

/* The first `count` lanes: the rest of a block belongs to the next leaf. */
static inline void store_block(fmm_lanes v, __global float* to, uint count) {
  if (count == FMM_LANES) {
    store_fmm(v, to);
    return;
  }
  float lanes[FMM_LANES];
  store_fmm(v, lanes);
  for (uint k = 0u; k < count; ++k)
    to[k] = lanes[k];
}

/* The same, added to what is there. Not by load_fmm: the rest of the block is being written by others. */
static inline void add_block(fmm_lanes v, __global float* to, uint count) {
  if (count == FMM_LANES) {
    store_fmm(load_fmm(to) + v, to);
    return;
  }
  float lanes[FMM_LANES];
  store_fmm(v, lanes);
  for (uint k = 0u; k < count; ++k)
    to[k] += lanes[k];
}
