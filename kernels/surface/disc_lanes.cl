/* meet of kernels/surface/disc.cl in vectors: one ray against a block of discs, or sixteen rays of one origin against a
 * disc. */
#include "lib/lanes.cl"
#include "lib/vector.cl"
#include "shared/octree_types.h"
#include "surface/clip.cl"
#include "surface/disc.cl"

/* What a ray finds on each splat of a block: a Meeting (kernels/surface/meeting.cl) in lanes. */
typedef struct BlockHits {
  lanes_f t, q, radius, nx, ny, nz;
  lanes_i inside; /* the ray meets the splat */
  uint first;     /* index of lane 0 in the point pool */
  uint sheets;    /* bit k: lane k is a side of a sheet */
#ifdef HAS_CLIPS
  uint flat; /* bit k: lane k is flat */
#endif
#ifdef HAS_MLS
  bool more; /* some patch is met twice */
#endif
} BlockHits;

/* What is known of the splats before a ray is. */
static inline BlockHits block_of_discs(const __global float* block) {
  BlockHits h;
  h.radius = load_lanes(block + WIDE_RADIUS(WIDE_LANES));
  h.nx = load_lanes(block + WIDE_NORMAL(WIDE_LANES, 0));
  h.ny = load_lanes(block + WIDE_NORMAL(WIDE_LANES, 1));
  h.nz = load_lanes(block + WIDE_NORMAL(WIDE_LANES, 2));
  h.first = as_uint(block[WIDE_FIRST(WIDE_LANES)]);
  h.sheets = as_uint(block[WIDE_SHEETS(WIDE_LANES)]);
#ifdef HAS_CLIPS
  h.flat = as_uint(block[WIDE_FLAT(WIDE_LANES)]);
#endif
  return h;
}

/* meet in lanes, bit-identical. */
static inline BlockHits meet_lanes(const __global float* block, float3 origin, float3 direction) {
  BlockHits h = block_of_discs(block);
  const lanes_f cx = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 0)) - origin.x;
  const lanes_f cy = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 1)) - origin.y;
  const lanes_f cz = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 2)) - origin.z;
  h.t = fma(h.nx, cx, fma(h.ny, cy, h.nz * cz)) /
        fma(h.nx, (lanes_f)(direction.x), fma(h.ny, (lanes_f)(direction.y), h.nz * direction.z));
  const lanes_f ox = fma(h.t, (lanes_f)(direction.x), -cx), oy = fma(h.t, (lanes_f)(direction.y), -cy),
                oz = fma(h.t, (lanes_f)(direction.z), -cz);
  const lanes_f distance2 = fma(ox, ox, fma(oy, oy, oz * oz)), r2 = h.radius * h.radius;
  h.q = distance2 / r2;
  h.inside = (distance2 <= r2) & (h.radius > 0.0f);
  return h;
}

/* Runs `body` for what a ray finds on the splats of a block, `h`: once, and of patches that are met twice once more. */
#ifndef HAS_MLS /* else kernels/surface/mls_lanes.cl, as the two macros that follow */
#define FOR_HITS_OF_BLOCK(block, ray, h, body)                                     \
  {                                                                                \
    const BlockHits h = meet_lanes(block, (ray).origin, (ray).direction);          \
    body                                                                           \
  }

/* KEPT_NORMAL: the surface's normal and the splat's material at the hit in a lane, which is point i. */
#define KEEP_NORMALS(h, kept)
#define KEPT_NORMAL(kept, lane, i) pool_point_texel(POINT_TEXELS * (i) + 1u)
#endif

/* Cosines of the splats' normals with a ray: dot3, bit-identical. */
static inline lanes_f cosines_of_lanes(const BlockHits* h, float3 direction) {
  return fma(h->nx, (lanes_f)(direction.x), fma(h->ny, (lanes_f)(direction.y), h->nz * direction.z));
}

/* meet of sixteen rays with the unit directions (dx, dy, dz), bit-identical. centre: from the rays' origin. */
static inline float16 meet_rays(float16 dx, float16 dy, float16 dz, float3 centre, float radius, float3 normal,
                                int16* inside) {
  const float16 t = dot3(normal, centre) / fma((float16)(normal.x), dx, fma((float16)(normal.y), dy, normal.z * dz));
  const float16 x = fma(t, dx, (float16)(-centre.x)), y = fma(t, dy, (float16)(-centre.y)), z = fma(t, dz, (float16)(-centre.z));
  *inside = fma(x, x, fma(y, y, z * z)) <= radius * radius;
  return t;
}

/* Of the lanes of a block that are met at h->t, those where the disc is not clipped off. Clips stand in the pool of the
 * blocks. */
#ifdef HAS_CLIPS
static inline lanes_i unclipped_lanes(const __global float* blocks, const __global float* block, float3 origin,
                                      float3 direction, lanes_f t, lanes_i met) {
  const uint clipped = as_uint(block[WIDE_CLIPPED(WIDE_LANES)]);
  if (clipped == 0u || !any_lane(met))
    return met;
  int met_of[WIDE_LANES];
  float t_of[WIDE_LANES];
  store_lanes(met, met_of);
  store_lanes(t, t_of);
  const __global float* clips = blocks + as_uint(block[WIDE_CLIPS(WIDE_LANES)]);
  for (int part = 0; part < WIDE_LANES / 8; ++part)
    for (ulong left = byte_a_lane(vload8(part, met_of)); left != 0ul; left &= left - 1ul) {
      const uint lane = 8u * part + lowest_byte(left), bit = 1u << lane;
      if ((clipped & bit) == 0u)
        continue;
      const float3 centre = (float3)(block[WIDE_CENTRE(WIDE_LANES, 0) + lane], block[WIDE_CENTRE(WIDE_LANES, 1) + lane],
                                     block[WIDE_CENTRE(WIDE_LANES, 2) + lane]);
      if (is_clipped_off(clips + CLIP_WORDS * popcount(clipped & (bit - 1u)),
                         fma((float3)(t_of[lane]), direction, origin - centre)))
        met_of[lane] = 0;
    }
  return load_lanes(met_of);
}
#define UNCLIPPED_LANES(block, ray, h, met) unclipped_lanes(block_pool, block, (ray).origin, (ray).direction, (h).t, met)
#else
#define UNCLIPPED_LANES(block, ray, h, met) (met)
#endif
