/* The traversal interface, on the form of the octree that was chosen: trace_closest, trace_any and trace_blended.
 *   FORM_STEP  cells, Begin-End pool, extra splats: kernels/lib/step_traversal.cl
 *   FORM_WIDE  tight child boxes, blocks of splats: kernels/lib/wide_traversal.cl */
#include "lib/blend.cl"
#include "lib/pools.cl"
#if TRAVERSAL_FORM == FORM_WIDE
#include "lib/wide_traversal.cl"
#else
#include "lib/step_traversal.cl"
#endif

#define MAX_RIMS 16 /* rims of discs, one behind another, that a ray passes before it is taken for a miss */

/* Whether a ray that met the back of this disc met a part of it that is not there: where a surface bends away from the
 * viewer, rims of discs from behind its horizon stick out. The middle of such a disc is hidden behind a front side; that
 * of a disc on the inside of an open surface is not. */
inline bool sticks_out(POOL_PARAMS, Ray ray, float3 middle) {
  ray.direction = middle - ray.origin;
  ray.t_max = sqrt(dot3(ray.direction, ray.direction));
  ray.direction /= ray.t_max;
  const Hit hit = trace_closest(POOL_ARGS, ray);
  return hit.splat != NO_SPLAT && dot3(pool_point_texel(POINT_TEXELS * hit.splat + 1u).xyz, ray.direction) < 0.0f;
}

/* Nearest hit that counts for a viewer: trace_closest without rims that stick out. */
inline Hit trace_visible(POOL_PARAMS, Ray ray) {
  Ray rest = ray;
  for (int k = 0; k < MAX_RIMS; ++k) {
    const Hit hit = trace_closest(POOL_ARGS, rest);
    if (hit.splat == NO_SPLAT || dot3(pool_point_texel(POINT_TEXELS * hit.splat + 1u).xyz, ray.direction) < 0.0f ||
        !sticks_out(POOL_ARGS, ray, pool_point_texel(POINT_TEXELS * hit.splat).xyz))
      return hit;
    rest.t_min = hit.t;
  }
  const Hit none = {ray.t_max, NO_SPLAT};
  return none;
}

/* The surface near the first hit: overlapping splats blended (kernels/lib/blend.cl). */
inline bool trace_blended(POOL_PARAMS, Ray ray, Surface* surface) {
  const Hit first = trace_visible(POOL_ARGS, ray);
  if (first.splat == NO_SPLAT)
    return false;
  Blend blend;
  blend_begin(&blend, ray, first.splat, pool_point_texel(POINT_TEXELS * first.splat),
              pool_point_texel(POINT_TEXELS * first.splat + 1u), pool_point_texel(POINT_TEXELS * first.splat + 2u).xyz);
  blend_others(POOL_ARGS, ray, &blend);
  blend_end(&blend, ray, surface);
  return true;
}
