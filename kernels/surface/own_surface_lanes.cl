/* kernels/surface/own_surface.cl for the discs of a block that a ray meets. */
#include "lib/pools.cl"
#include "surface/disc_lanes.cl"
#ifdef HAS_MLS
#include "surface/mls_lanes.cl"
#endif
#include "surface/own_surface.cl"

static inline lanes_i sheet_lanes(const BlockHits* h) { return (((lanes_u)(h->sheets) >> LANE_NUMBERS) & 1u) != 0u; }

#ifdef HAS_CLIPS
static inline lanes_i flat_lanes(const BlockHits* h) { return (((lanes_u)(h->flat) >> LANE_NUMBERS) & 1u) != 0u; }
#endif

/* is_apart in lanes. along: cosines of the discs' normals with the direction. */
#ifdef HAS_CLIPS
static inline lanes_i apart_lanes(lanes_f along, lanes_f distance, const BlockHits* h) {
  return flat_lanes(h) & (distance * fabs(along) > FLAT_HEIGHT);
}
#else
static inline lanes_i apart_lanes(lanes_f along, lanes_f distance, const BlockHits* h) { return (lanes_i)(0); }
#endif

/* is_turned in lanes. */
static inline lanes_i turned_lanes(float3 end_normal, float end_radius, float3 direction, lanes_f distance,
                                   const BlockHits* h) {
  if (h->sheets == 0u)
    return (lanes_i)(0);
  const lanes_f cosine = cosines_of_lanes(h, end_normal), along = cosines_of_lanes(h, direction);
  return sheet_lanes(h) & (cosine < 0.0f) & (distance * fabs(along) < SHEET_HEIGHT * (end_radius + h->radius)) &
         ~apart_lanes(along, distance, h);
}

/* belongs_to_end in lanes. `turned`: turned_lanes of the end. */
static inline lanes_i lanes_of_end(float3 end_normal, float end_radius, float steepness, lanes_f distance,
                                   lanes_i turned, const BlockHits* h) {
  const lanes_f own_cosine = cosines_of_lanes(h, end_normal);
  const lanes_f cosine = select(own_cosine, -own_cosine, turned);
  /* COINCIDENT in lanes */
  const lanes_f coincident = clamp(0.01f * (end_radius + h->radius), ROUNDING_OF_HITS, MOST_COINCIDENT);
  return ((steepness * distance < SELF_HIT_REACH * (end_radius + h->radius)) & (cosine > SELF_HIT_COSINE)) |
         ((distance < coincident) & (cosine < -SELF_HIT_COSINE));
}

/* disc_belongs_to_end in lanes. */
static inline lanes_i discs_of_end(float3 end_normal, float end_radius, float steepness, float3 away, lanes_f distance,
                                   const BlockHits* h) {
  const lanes_i turned = turned_lanes(end_normal, end_radius, away, distance, h);
  const lanes_f own_along = cosines_of_lanes(h, away);
  const lanes_i own = lanes_of_end(end_normal, end_radius, steepness, distance, turned, h) &
                      ~apart_lanes(own_along, distance, h);
  if (h->sheets == 0u)
    return own;
  const lanes_f along = select(own_along, -own_along, turned);
  return own & ~(sheet_lanes(h) & (along < 0.0f) & (distance > ARRIVAL_DISTANCE * h->radius));
}

#ifndef HAS_SPECULAR
/* belongs_to_origin in lanes. */
static inline lanes_i lanes_of_origin(OcclusionEnds ends, float3 direction, const BlockHits* h) {
  const lanes_i turned = turned_lanes(ends.origin_normal, ends.origin_radius, direction, h->t, h);
  const lanes_f own_along = cosines_of_lanes(h, direction);
  const lanes_f along = select(own_along, -own_along, turned);
  return lanes_of_end(ends.origin_normal, ends.origin_radius, steepness_at_end(ends.origin_normal, direction), h->t, turned,
                      h) &
         ~apart_lanes(own_along, h->t, h) & ~((along < 0.0f) & (h->t > ARRIVAL_DISTANCE * h->radius));
}
#define LANES_OF_ORIGIN(h, met) lanes_of_origin(ends, ray.direction, h)
#else
/* belongs_to_origin of the lanes that are met, one after another: few are, near the start of a ray, and blocks do not
 * hold materials. */
static inline lanes_i lanes_of_origin(POOL_PARAMS, OcclusionEnds ends, float3 direction, const BlockHits* h, lanes_i met) {
  float t_of[WIDE_LANES];
  uint belong = 0u; /* bit k: lane k does */
  store_lanes(select((lanes_f)(INFINITY), h->t, met), t_of);
  KEEP_NORMALS(h, normal_of);
  for (uint lane = 0u; lane < WIDE_LANES; ++lane)
    if (t_of[lane] < INFINITY) {
      const uint i = h->first + lane;
      if (belongs_to_origin(ends, direction, t_of[lane], pool_point_texel(POINT_TEXELS * i).w, KEPT_NORMAL(normal_of, lane, i)))
        belong |= 1u << lane;
    }
  return (((lanes_u)(belong) >> LANE_NUMBERS) & 1u) != 0u;
}
#define LANES_OF_ORIGIN(h, met) lanes_of_origin(POOL_ARGS, ends, ray.direction, h, met)
#endif
