/* Blocks of FMM_LANES nodes or points: of the block at p, load_fmm(p) is what this work-item has of it.
 *   FMM_ITEM_LANES  lanes of a block a work-item: all 8, as vectors of the language, for CPU compilers do not vectorise
 *                   diverging work-items; or 1, for devices whose work-items are lanes already: vectors take two to four
 *                   times the registers there, and neighbours would read what lies eight numbers apart */
#include "shared/fmm_types.h"
#ifndef FMM_ITEM_LANES
#define FMM_ITEM_LANES 8
#endif
#if FMM_ITEM_LANES != 1 && FMM_ITEM_LANES != FMM_LANES
#error "a work-item takes all lanes of a block, or one"
#endif

/* FMM_BLOCK: number of this work-item's block in the launch, which has FMM_LANES / FMM_ITEM_LANES work-items a block.
 * FMM_OWN_BITS: of a bit a lane, those of this work-item's lanes. */
#if FMM_ITEM_LANES == 1
typedef float fmm_lanes;
typedef int fmm_mask;
#define FMM_BLOCK ((uint)(get_global_id(0) / FMM_LANES))
#define FMM_LANE_NUMBERS ((int)(get_global_id(0) % FMM_LANES))
#define FMM_OWN_BITS (1u << FMM_LANE_NUMBERS)
#define load_fmm(p) ((p)[FMM_LANE_NUMBERS])
#define store_fmm(v, p) ((p)[FMM_LANE_NUMBERS] = (v))
#define fmm_float(v) ((float)(v))

static inline bool fmm_any(fmm_mask m) { return m != 0; }
#else
typedef float8 fmm_lanes;
typedef int8 fmm_mask;
#define FMM_BLOCK ((uint)get_global_id(0))
#define FMM_LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#define FMM_OWN_BITS 255u
#define load_fmm(p) vload8(0, p)
#define store_fmm(v, p) vstore8(v, 0, p)
#define fmm_float(v) convert_float8(v)

static inline bool fmm_any(fmm_mask m) {
  return (as_ulong(convert_char8(m)) & 0x8080808080808080ul) != 0ul; /* true is -1 */
}
#endif

#define INVERSE_PI 0.318309886f

#if FMM_ITEM_LANES == 1
/* The first `count` lanes: the rest of a block belongs to the next leaf. */
static inline void store_block(fmm_lanes v, __global float* to, uint count) {
  if (FMM_LANE_NUMBERS < (int)count)
    store_fmm(v, to);
}

/* The same, added to what is there. */
static inline void add_block(fmm_lanes v, __global float* to, uint count) {
  if (FMM_LANE_NUMBERS < (int)count)
    store_fmm(load_fmm(to) + v, to);
}
#else
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
#endif
