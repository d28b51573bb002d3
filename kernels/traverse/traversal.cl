/* The traversal interface, on the form of the octree that was chosen: trace_closest, trace_any and trace_blended;
 * trace_closest_from, which alone pays for the end it looks at.
 *   BOUNCED_RAYS  defined by programs whose viewers' rays also start on surfaces; all are where HAS_SPECULAR
 *   FORM_STEP  cells, Begin-End pool, extra splats: kernels/traverse/step_traversal.cl
 *   FORM_WIDE  tight child boxes, blocks of splats: kernels/traverse/wide_traversal.cl */
#if defined(HAS_SPECULAR) && !defined(BOUNCED_RAYS)
#define BOUNCED_RAYS
#endif
#include "lib/lanes8.cl"
#include "lib/pools.cl"
#include "surface/surface.cl"
#if TRAVERSAL_FORM == FORM_WIDE
#include "traverse/wide_traversal.cl"
#else
#include "traverse/step_traversal.cl"
#endif

#define MAX_RIMS 16 /* rims, one behind another, that a ray passes; the last one then counts */

/* trace_closest, or trace_closest_from in programs whose rays also leave surfaces: one walk in the code, not two. */
static inline Hit trace_closest_of(POOL_PARAMS, Ray ray, OcclusionEnds ends) {
#ifdef BOUNCED_RAYS
  return trace_closest_from(POOL_ARGS, ray, ends);
#else
  return trace_closest(POOL_ARGS, ray);
#endif
}

/* Of a sheet's two points, which a ray meets in one place, the one that faces it; any other point as it is. */
static inline uint facing_side(POOL_PARAMS, Ray ray, Hit hit) {
  const float4 normal = normal_at_hit(POOL_ARGS, ray, hit.t, hit.splat);
  const float side = SHEET_SIDE(normal.w);
  if (side == 0.0f || !is_back(normal.xyz, ray.direction))
    return hit.splat;
  return side == SHEET_FRONT ? hit.splat + 1u : hit.splat - 1u;
}

/* Whether the back of the disc `centre` is a rim that sticks out. */
static inline bool sticks_out(POOL_PARAMS, Ray ray, OcclusionEnds ends, float4 centre) {
  float distance;
  const Ray to_middle = rim_ray(ray, centre, &distance);
  const Hit hit = trace_closest_of(POOL_ARGS, to_middle, ends);
  if (hit.splat == NO_SPLAT)
    return false;
  const uint facing = facing_side(POOL_ARGS, to_middle, hit);
  return hides_rim(to_middle.direction, distance, centre.w, hit.t, pool_point_texel(POINT_TEXELS * facing),
                   normal_at_hit(POOL_ARGS, to_middle, hit.t, facing).xyz);
}

#ifdef HAS_SPECULAR
/* The next hit within `reach` behind `hit`, as if the ray had come through the surface there: what lies in the same plane,
 * before or behind it by rounding, is met. */
static inline Hit hit_behind(POOL_PARAMS, Ray ray, OcclusionEnds ends, Hit hit, float reach) {
  const float4 normal = normal_at_hit(POOL_ARGS, ray, hit.t, hit.splat);
  ends.origin_normal = normal.xyz;
  ends.origin_radius = pool_point_texel(POINT_TEXELS * hit.splat).w;
  ends.origin_material = (uint)normal.w + 1u;
  ends.origin_back = dot3(normal.xyz, ray.direction) < 0.0f ? 1u : 0u;
  ends.origin_through = 1u;
  ray.origin = fma((float3)(hit.t), ray.direction, ray.origin);
  ray.t_min = -SEGMENT_MARGIN(ends.origin_radius);
  ray.t_max = reach;
  Hit behind = trace_closest_from(POOL_ARGS, ray, ends);
  behind.t += hit.t;
  return behind;
}

static inline bool is_of_medium(POOL_PARAMS, OcclusionEnds ends, uint splat) {
  return (uint)pool_point_texel(POINT_TEXELS * splat + 1u).w + 1u == ends.medium;
}

/* Where glass stands on something, the two planes are one: rounding must not say which of them a ray in the glass meets. It
 * meets the glass. */
static inline Hit glass_first(POOL_PARAMS, Ray ray, OcclusionEnds ends, Hit hit) {
  if (ends.medium == 0u || hit.splat == NO_SPLAT || is_of_medium(POOL_ARGS, ends, hit.splat))
    return hit;
  const Hit behind = hit_behind(POOL_ARGS, ray, ends, hit, SEGMENT_MARGIN(pool_point_texel(POINT_TEXELS * hit.splat).w));
  return behind.splat != NO_SPLAT && is_of_medium(POOL_ARGS, ends, behind.splat) ? behind : hit;
}
#endif

/* The nearest hit that counts for a viewer, `hit` being the ray's nearest of all: goes on past rims that stick out. A sheet
 * has no backs. Adds the rays traced to *rays. */
static inline Hit visible_hit(POOL_PARAMS, Ray ray, OcclusionEnds ends, Hit hit, float* rays) {
  Ray rest = ray;
  for (int k = 0; k < MAX_RIMS; ++k) {
    if (hit.splat == NO_SPLAT)
      break;
    const float4 normal = normal_at_hit(POOL_ARGS, ray, hit.t, hit.splat);
    if (!is_back(normal.xyz, ray.direction) || is_sheet(normal.w))
      break;
#ifdef HAS_SPECULAR
    /* From inside glass its backs are what there is to see. */
    if (is_of_medium(POOL_ARGS, ends, hit.splat))
      break;
#endif
    *rays += 1.0f;
    if (!sticks_out(POOL_ARGS, ray, ends, pool_point_texel(POINT_TEXELS * hit.splat)))
      break;
    *rays += 1.0f;
#ifdef HAS_SPECULAR
    hit = hit_behind(POOL_ARGS, ray, ends, hit, INFINITY);
#else
    rest.t_min = hit.t;
    hit = trace_closest_of(POOL_ARGS, rest, ends);
#endif
  }
  return hit;
}

/* The surface that a viewer sees, `hit` being the ray's nearest hit of all: overlapping splats near the first that counts
 * are blended (kernels/surface/blend.cl). `ends`: of the surface that the ray leaves, or free. Adds the rays traced to *rays. */
static inline bool blended_surface(POOL_PARAMS, Ray ray, OcclusionEnds ends, Hit hit, Surface* surface, float* rays) {
#ifdef HAS_SPECULAR
  hit = glass_first(POOL_ARGS, ray, ends, hit);
#endif
  Hit first = visible_hit(POOL_ARGS, ray, ends, hit, rays);
  if (first.splat == NO_SPLAT)
    return false;
  first.splat = facing_side(POOL_ARGS, ray, first);
  Blend blend;
  blend_begin(POOL_ARGS, &blend, ray, first);
  blend_others(POOL_ARGS, ray, &blend);
  blend_end(&blend, ray, surface);
  return true;
}

static inline bool trace_blended(POOL_PARAMS, Ray ray, Surface* surface, float* rays) {
  *rays += 1.0f;
  return blended_surface(POOL_ARGS, ray, free_ends(), trace_closest(POOL_ARGS, ray), surface, rays);
}
