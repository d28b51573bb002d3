/* The truth beside every traversal: each ray against each splat of the pool, without the octree. For tests.
 * NDRange: 1-D, one work-item a ray, padded. answers[i] = nearest hit of rays[i], ties to the lowest index. */
#include "lib/pools.cl"
#include "lib/ray.cl"
#include "lib/ray_splat.cl"

__kernel void brute_force_closest(const __global float4* points, uint point_count, const __global RayQuery* rays,
                                  __global RayAnswer* answers, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const float3 origin = load3(rays[i].origin), direction = load3(rays[i].direction);
  float best = rays[i].t_max;
  uint splat = NO_SPLAT;
  for (uint k = 0u; k < point_count; ++k) {
    float q;
    const float t = ray_disc(origin, direction, points[POINT_TEXELS * k], points[POINT_TEXELS * k + 1u].xyz, &q);
    if (t > rays[i].t_min && t < best) {
      best = t;
      splat = k;
    }
  }
  answers[i].t = best;
  answers[i].splat = splat;
}
