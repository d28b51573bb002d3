/* Given rays through the chosen traversal: for tests, probes and later stages.
 * NDRange: 1-D, one work-item a ray, padded; work-items past `count` do nothing. */
#include "traverse/traversal.cl"

static inline Ray ray_of_query(const __global RayQuery* q, float step_delta) {
  Ray ray;
  ray.origin = load3(q->origin);
  ray.direction = load3(q->direction);
  ray.t_min = q->t_min;
  ray.t_max = q->t_max;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  return ray;
}

/* answers[i] = nearest hit of rays[i]. */
__kernel OWN_VECTORS void trace_closest_rays(POOL_PARAMS, const __global RayQuery* rays, __global RayAnswer* answers, uint count,
                                 float step_delta) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Hit hit = trace_closest(POOL_ARGS, ray_of_query(rays + i, step_delta));
  answers[i].t = hit.t;
  answers[i].splat = hit.splat;
}

/* answers[i] = nearest hit of rays[i] that does not belong to the surface which it leaves: surfaces[i] = (normal, radius). */
__kernel OWN_VECTORS void trace_closest_from_rays(POOL_PARAMS, const __global RayQuery* rays, const __global float4* surfaces,
                                      __global RayAnswer* answers, uint count, float step_delta) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const OcclusionEnds ends = {surfaces[i].xyz, (float3)(0.0f), surfaces[i].w, 0.0f};
  const Hit hit = trace_closest_from(POOL_ARGS, ray_of_query(rays + i, step_delta), ends);
  answers[i].t = hit.t;
  answers[i].splat = hit.splat;
}

/* blocked[i] = 1 when any disc is hit in (t_min, t_max) of rays[i], else 0. Both ends are free: nothing is excluded. */
__kernel OWN_VECTORS void trace_any_rays(POOL_PARAMS, const __global RayQuery* rays, __global uint* blocked, uint count,
                             float step_delta) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  blocked[i] = trace_any(POOL_ARGS, ray_of_query(rays + i, step_delta), free_ends()) ? 1u : 0u;
}

/* surfaces[i] = (normal, t) of the blended surface of rays[i], then (albedo, 1); the second w is 0 where nothing is hit. */
__kernel OWN_VECTORS void trace_blended_rays(POOL_PARAMS, const __global RayQuery* rays, __global float4* surfaces, uint count,
                                 float step_delta) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  Surface s;
  float traced = 0.0f;
  const bool hit = trace_blended(POOL_ARGS, ray_of_query(rays + i, step_delta), &s, &traced);
  surfaces[2u * i] = hit ? (float4)(s.normal, s.t) : (float4)(0.0f);
  surfaces[2u * i + 1u] = hit ? (float4)(s.albedo, 1.0f) : (float4)(0.0f);
}

#ifdef RAY_PACKETS /* packets go through the wide form, on CPU devices */
#include "traverse/wide_packet.cl"

/* answers[i] = nearest hits of packets[i]. NDRange: 1-D, one work-item a packet, padded. */
__kernel OWN_VECTORS void trace_packets(POOL_PARAMS, const __global RayPacketQuery* packets, __global RayPacketAnswer* answers,
                            uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  RayPacket p;
  for (int g = 0; g < PACKET_GROUPS; ++g) {
    p.x[g] = vload16(g, packets[i].direction[0]);
    p.y[g] = vload16(g, packets[i].direction[1]);
    p.z[g] = vload16(g, packets[i].direction[2]);
  }
  p.origin = load3(packets[i].origin);
  p.t_min = packets[i].t_min;
  p.t_max = packets[i].t_max;
  PacketHits hits;
  trace_packet(POOL_ARGS, &p, &hits);
  for (int g = 0; g < PACKET_GROUPS; ++g) {
    vstore16(hits.t[g], g, answers[i].t);
    vstore16(hits.splat[g], g, answers[i].splat);
  }
}
#endif
