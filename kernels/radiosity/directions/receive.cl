/* Irradiance of the points from what they see in a set of directions: H = sum over k of w_k B(hit k), the weights being the
 * directions' form factors, which sum to 1 (method.md section 8). */
#include "radiosity/directions/hits.cl"

/* irradiance[i].xyz for first <= i < end. NDRange: 1-D, padded, a work-item a point.
 *   hits       as trace_directions writes them, of the points from held_from on
 *   weights    `count` of them
 *   radiosity  .xyz, of all points of the pool; 0 of those that send no light */
__kernel void receive_by_directions(const __global uint* hits, uint held_from, uint first, uint end,
                                    const __global float* weights, uint count, const __global float4* radiosity,
                                    __global float4* irradiance) {
  const uint i = first + get_global_id(0);
  if (i >= end)
    return;
  const uint held = i - held_from;
  float4 sum = (float4)(0.0f);
  for (uint k = 0u; k < count; ++k) {
    const uint splat = hits[HIT_AT(held, k, count)];
    if (splat < BACK_SEEN)
      sum += weights[k] * radiosity[splat];
  }
  irradiance[i] = sum;
}
