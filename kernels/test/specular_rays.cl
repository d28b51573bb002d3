/* Given rays along their way over specular surfaces, for tests: each is let through by glass unless all of it is reflected.
 * NDRange: 1-D, one work-item a ray, padded. ends[2 i] = (origin of the ray's last part, surfaces that scattered it),
 * ends[2 i + 1] = (its direction, distance to what ends it: a surface that is diffuse or shows its back, or infinity). */
#include "lib/sampling.cl"
#include "materials/materials.cl"

/* Just below 1: what is reflected with less than that probability is let through. */
#define LET_THROUGH 0x1.fffffep-1f
#define MOST_SURFACES 64u

__kernel OWN_VECTORS void trace_specular_rays(POOL_PARAMS, const __global Material* materials, const __global RayQuery* rays,
                                  __global float4* ends_of, uint count, float step_delta) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  Ray ray;
  ray.origin = load3(rays[i].origin);
  ray.direction = load3(rays[i].direction);
  ray.t_min = rays[i].t_min;
  ray.t_max = rays[i].t_max;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  OcclusionEnds ends = free_ends();
  Media media = in_air();
  float traced = 0.0f, t = INFINITY;
  uint surfaces = 0u;
  for (; surfaces < MOST_SURFACES; ++surfaces) {
    Surface s;
    Scatter scatter;
    t = INFINITY;
    if (!blended_surface(POOL_ARGS, ray, ends, trace_closest_from(POOL_ARGS, ray, ends), &s, &traced))
      break;
    t = s.t;
    media = media_before(media, &s, materials);
    if (!scatter_ray(&s, materials, ray.direction, (float2)(LET_THROUGH), &media, &scatter))
      break;
    ray = scattered_ray(&s, &scatter, step_delta);
    ends = scattered_ends(&s, &scatter, media);
  }
  ends_of[2u * i] = (float4)(ray.origin, (float)surfaces);
  ends_of[2u * i + 1u] = (float4)(ray.direction, t);
}
