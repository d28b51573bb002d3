/* Vectors of as many numbers as a block of splats has lanes.
 *   WIDE_LANES  splats a block, 8 or 16 */
#ifndef WIDE_LANES
#define WIDE_LANES 8
#endif
#include "lib/lanes8.cl"

#if WIDE_LANES == 16
typedef float16 lanes_f;
typedef int16 lanes_i;
typedef uint16 lanes_u;
#define load_lanes(p) vload16(0, p)
#define store_lanes(v, p) vstore16(v, 0, p)
#define as_lanes_i as_int16
#define LANE_NUMBERS ((uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define HALVES(op, v) op((v).lo, (v).hi)
#else
typedef float8 lanes_f;
typedef int8 lanes_i;
typedef uint8 lanes_u;
#define load_lanes(p) vload8(0, p)
#define store_lanes(v, p) vstore8(v, 0, p)
#define as_lanes_i as_int8
#define LANE_NUMBERS ((uint8)(0, 1, 2, 3, 4, 5, 6, 7))
#define HALVES(op, v) (v)
#endif

#if WIDE_LANES == 16
static inline bool any_lane(lanes_i v) { return byte_a_lane(v.lo | v.hi) != 0ul; }
#else
static inline bool any_lane(lanes_i v) { return byte_a_lane(v) != 0ul; }
#endif

static inline float smallest_lane(lanes_f v) { return smallest8(HALVES(min, v)); }

static inline uint smallest_lane_u(lanes_u v) {
  const uint8 a = HALVES(min, v);
  const uint4 b = min(a.lo, a.hi);
  return min(min(b.x, b.y), min(b.z, b.w));
}
