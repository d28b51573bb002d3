/* kernels/surface/own_surface.cl for the discs of a block that a ray meets. */
#include "lib/pools.cl"
#include "surface/disc_lanes.cl"
#include "surface/own_surface.cl"

/* belongs_to_end in lanes, to the same answers. */
static inline lanes_i lanes_of_end(float3 end_normal, float end_radius, float steepness, lanes_f distance,
                                   const BlockHits* h) {
  const lanes_f cosine = fma(h->nx, (lanes_f)(end_normal.x),
                             fma(h->ny, (lanes_f)(end_normal.y), h->nz * end_normal.z));
  /* COINCIDENT in lanes */
  const lanes_f coincident = clamp(0.01f * (end_radius + h->radius), ROUNDING_OF_HITS, MOST_COINCIDENT);
  return ((steepness * distance < SELF_HIT_REACH * (end_radius + h->radius)) & (cosine > SELF_HIT_COSINE)) |
         ((distance < coincident) & (cosine < -SELF_HIT_COSINE));
}

#ifndef HAS_SPECULAR
/* belongs_to_origin in lanes. */
static inline lanes_i lanes_of_origin(ShadowEnds ends, float3 direction, const BlockHits* h) {
  const lanes_f along = fma(h->nx, (lanes_f)(direction.x), fma(h->ny, (lanes_f)(direction.y), h->nz * direction.z));
  return lanes_of_end(ends.origin_normal, ends.origin_radius, steepness_at_end(ends.origin_normal, direction), h->t, h) &
         ~((along < 0.0f) & (h->t > ARRIVAL_DISTANCE * h->radius));
}
#define LANES_OF_ORIGIN(h, met) lanes_of_origin(ends, ray.direction, h)
#else
/* belongs_to_origin of the lanes that are met, one after another: few are, near the start of a ray, and blocks do not
 * hold materials. */
static inline lanes_i lanes_of_origin(POOL_PARAMS, ShadowEnds ends, float3 direction, const BlockHits* h, lanes_i met) {
  float t_of[WIDE_LANES];
  uint belong = 0u; /* bit k: lane k does */
  store_lanes(select((lanes_f)(INFINITY), h->t, met), t_of);
  for (uint lane = 0u; lane < WIDE_LANES; ++lane)
    if (t_of[lane] < INFINITY) {
      const uint i = POINT_TEXELS * (h->first + lane);
      if (belongs_to_origin(ends, direction, t_of[lane], pool_point_texel(i).w, pool_point_texel(i + 1u)))
        belong |= 1u << lane;
    }
  return (((lanes_u)(belong) >> LANE_NUMBERS) & 1u) != 0u;
}
#define LANES_OF_ORIGIN(h, met) lanes_of_origin(POOL_ARGS, ends, ray.direction, h, met)
#endif
