/* The truth beside every traversal: each ray against each splat of the pool, without the octree. For tests.
 * NDRange: 1-D, one work-item a ray, padded. answers[i] = nearest hit of rays[i], ties to the lowest index; for
 * FRONTS_ONLY as for the octree (kernels/surface/disc.cl); for HAS_CLIPS splat i has clips[i], for HAS_MLS a
 * PatchBend behind each point;
 * brute_force_closest_from of those that do not belong to the surface which it leaves, surfaces[i] = (normal, radius). */
#include "lib/pools.cl"
#include "lib/ray.cl"
#include "surface/clip.cl"
#include "surface/disc.cl"
#include "surface/meeting.cl"
#include "surface/own_surface.cl"

#ifdef HAS_CLIPS
#define CLIP_PARAM , const __global DiscClip* clips
#define CLIP_ARG , clips
#define IS_CUT(k, off) is_clipped_off((const __global float*)(clips + (k)), off)
#else
#define CLIP_PARAM
#define CLIP_ARG
#define IS_CUT(k, off) false
#endif

static inline RayAnswer nearest_of_all(const __global float4* points, uint point_count, const __global RayQuery* ray,
                                       bool leaves, OcclusionEnds ends CLIP_PARAM) {
  const float3 origin = load3(ray->origin), direction = load3(ray->direction);
  RayAnswer best = {ray->t_max, NO_SPLAT};
  for (uint k = 0u; k < point_count; ++k) {
    const float4 centre = points[POINT_TEXELS * k];
    FOR_MEETINGS(m, origin, direction, centre, points[POINT_TEXELS * k + 1u], points[POINT_TEXELS * k + 3u], {
      if (m.t > ray->t_min && m.t < best.t && SIDE_COUNTS(dot3(m.normal.xyz, direction)) &&
          !(leaves && belongs_to_origin(ends, direction, m.t, centre.w, m.normal)) &&
          !IS_CUT(k, fma((float3)(m.t), direction, origin - centre.xyz))) {
        best.t = m.t;
        best.splat = k;
      }
    })
  }
  return best;
}

__kernel void brute_force_closest(const __global float4* points, uint point_count, const __global RayQuery* rays,
                                  __global RayAnswer* answers, uint count CLIP_PARAM) {
  const uint i = get_global_id(0);
  if (i < count)
    answers[i] = nearest_of_all(points, point_count, rays + i, false, free_ends() CLIP_ARG);
}

__kernel void brute_force_closest_from(const __global float4* points, uint point_count, const __global RayQuery* rays,
                                       const __global float4* surfaces, __global RayAnswer* answers, uint count CLIP_PARAM) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const OcclusionEnds ends = {surfaces[i].xyz, (float3)(0.0f), surfaces[i].w, 0.0f};
  answers[i] = nearest_of_all(points, point_count, rays + i, true, ends CLIP_ARG);
}
