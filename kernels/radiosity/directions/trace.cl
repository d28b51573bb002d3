/* Directional sampling (method.md section 8): which splat each point sees in each of a set of directions.
 *   HEMICUBE     see radiosity/directions/cell.cl
 *   RAY_PACKETS  direction k of BEAM_RAYS points at once, whose order keeps those together that lie close and face about
 *                the same way; not with HEMICUBE, whose directions are turned otherwise at each point, nor HAS_MLS */
#define BOUNCED_RAYS
#include "radiosity/directions/cell.cl"
#include "radiosity/directions/hits.cl"
#include "traverse/traversal.cl"
#ifdef RAY_PACKETS
#if defined(HEMICUBE) || defined(HAS_MLS)
#error "no beams of a hemicube's directions, nor through patches"
#endif
#include "radiosity/directions/beams.cl"
#endif

static inline OcclusionEnds ends_at(float4 centre, float4 normal) {
  OcclusionEnds ends = free_ends();
  ends.origin_normal = normal.xyz;
  ends.origin_radius = centre.w;
  return ends;
}

/* direction: to be set */
static inline Ray ray_off(float4 centre, float step_delta) {
  Ray ray;
  ray.origin = centre.xyz;
  ray.t_min = -SEGMENT_MARGIN(centre.w);
  ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  return ray;
}

/* The splat whose front is seen where `hit` is the ray's nearest of all; NO_SPLAT where the ray meets nothing, BACK_SEEN where
 * it meets the back of something, which is black. Adds the rays traced to *rays, and the inverse of the way to *inverse_way. */
static inline uint splat_seen(POOL_PARAMS, Ray ray, OcclusionEnds ends, Hit hit, float* rays, float* inverse_way) {
  *rays += 1.0f;
  hit = visible_hit(POOL_ARGS, ray, ends, hit, rays);
  if (hit.splat == NO_SPLAT)
    return NO_SPLAT;
  *inverse_way += 1.0f / fmax(hit.t, 1e-6f);
  hit.splat = facing_side(POOL_ARGS, ray, hit);
  return is_back(normal_at_hit(POOL_ARGS, ray, hit.t, hit.splat).xyz, ray.direction) ? BACK_SEEN : hit.splat;
}

/* hits[HIT_AT(i - held_from, k, count)] = the splat whose front the point places[i] of the pool sees in direction k, or what
 * splat_seen says.
 * NDRange: 1-D, padded, a work-item a point i, first <= i < end; with RAY_PACKETS the BEAM_RAYS points from
 * first + BEAM_RAYS get_global_id(0) on.
 *   directions  `count` cells (direction_in_cell)
 *   ways        [i] becomes the harmonic mean of the lengths of its rays, INFINITY where none meets anything
 *   rays        [0] grows by the number of rays traced, [1] by those of them that beams trace */
__kernel OWN_VECTORS void trace_directions(POOL_PARAMS, const __global uint* places, uint first, uint end,
                               const __global float4* directions, uint count, uint seed, __global uint* hits,
                               uint held_from, __global float* ways, __global uint* rays, float step_delta) {
#ifdef RAY_PACKETS
  const uint begin = first + BEAM_RAYS * (uint)get_global_id(0);
  if (begin >= end)
    return;
  const uint points = min((uint)BEAM_RAYS, end - begin);
  DirectionBeams beams = beams_of_points(POOL_ARGS, places, begin, points);
  float traced = 0.0f, inverse_way[BEAM_RAYS];
  for (uint j = 0u; j < BEAM_RAYS; ++j)
    inverse_way[j] = 0.0f;
  uint in_beams = 0u;
  for (uint k = 0u; k < count; ++k) {
    Hit found[BEAM_RAYS];
    float3 direction[BEAM_RAYS];
    const bool together = next_beam(POOL_ARGS, &beams, directions[k], k, seed, direction, found);
    in_beams += together ? points : 0u;
    for (uint j = 0u; j < points; ++j) {
      const float4 centre = pool_point_texel(POINT_TEXELS * beams.point[j]);
      const OcclusionEnds ends = ends_at(centre, pool_point_texel(POINT_TEXELS * beams.point[j] + 1u));
      Ray ray = ray_off(centre, step_delta);
      ray.direction = direction[j];
      const Hit hit = together ? found[j] : trace_closest_from(POOL_ARGS, ray, ends);
      hits[HIT_AT(begin + j - held_from, k, count)] = splat_seen(POOL_ARGS, ray, ends, hit, &traced, inverse_way + j);
    }
  }
  for (uint j = 0u; j < points; ++j)
    ways[begin + j] = (float)count / inverse_way[j];
  atomic_add(rays + 1, in_beams);
#else
  const uint i = first + get_global_id(0);
  if (i >= end)
    return;
  const uint point = places[i];
  const float4 centre = pool_point_texel(POINT_TEXELS * point), normal = pool_point_texel(POINT_TEXELS * point + 1u);
  const OcclusionEnds ends = ends_at(centre, normal);
  Ray ray = ray_off(centre, step_delta);
  float traced = 0.0f, inverse_way = 0.0f;
  for (uint k = 0u; k < count; ++k) {
    ray.direction = direction_in_cell(normal.xyz, directions[k], point, k, seed);
    hits[HIT_AT(i - held_from, k, count)] =
        splat_seen(POOL_ARGS, ray, ends, trace_closest_from(POOL_ARGS, ray, ends), &traced, &inverse_way);
  }
  ways[i] = (float)count / inverse_way;
#endif
  atomic_add(rays, (uint)traced);
}
