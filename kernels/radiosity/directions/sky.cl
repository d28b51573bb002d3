/* Irradiance of the points from the sky, by the directions in which they meet nothing.
 *   HAS_SKY_MAP  the sky is a map; else the same from every direction
 *   HEMICUBE     see radiosity/directions/cell.cl */
#include "radiosity/directions/cell.cl"
#include "radiosity/directions/hits.cl"
#ifdef HAS_SKY_MAP
#include "shared/sky_types.h"
#define SKY_PARAMS \
  const __global uint *places, const __global float4 *normals, const __global float4 *cells, uint seed, \
      const __global float4 *smooth_sky

/* Radiance in .xyz towards the direction, of any length above 0 (host/lights/smooth_sky.h). */
static inline float4 smooth_sky_towards(const __global float4* smooth_sky, float3 direction) {
  const float3 d = direction / (fabs(direction.x) + fabs(direction.y) + fabs(direction.z));
  float2 at = d.xy;
  if (d.z < 0.0f)
    at = copysign(1.0f - fabs(d.yx), d.xy);
  const uint2 texel = min(convert_uint2(fma(at, (float2)(0.5f * SMOOTH_SKY_SIDE), (float2)(0.5f * SMOOTH_SKY_SIDE))),
                          (uint2)(SMOOTH_SKY_SIDE - 1u));
  return smooth_sky[SMOOTH_SKY_SIDE * texel.y + texel.x];
}
#else
#define SKY_PARAMS float4 sky
#endif

/* irradiance[i].xyz [W/m2, scaled as RenderParams] for first <= i < end. NDRange: 1-D, padded, a work-item a point.
 *   hits     as trace_directions writes them, of the points from held_from on
 *   weights  `count` of them, of the directions
 * Without a map:
 *   sky      .xyz: its radiance
 * With one:
 *   places, cells, seed  those of trace_directions
 *   normals     .xyz: of point i
 *   smooth_sky  SMOOTH_SKY_SIDE^2 texels, .xyz: radiance */
__kernel void sky_by_directions(const __global uint* hits, uint held_from, uint first, uint end, const __global float* weights,
                                uint count, SKY_PARAMS, __global float4* irradiance) {
  const uint i = first + get_global_id(0);
  if (i >= end)
    return;
  const uint held = i - held_from;
#ifdef HAS_SKY_MAP
  const float3 normal = normals[i].xyz;
#endif
  float4 sum = (float4)(0.0f);
  for (uint k = 0u; k < count; ++k) {
    if (hits[HIT_AT(held, k, count)] != NO_SPLAT)
      continue;
#ifdef HAS_SKY_MAP
    sum += weights[k] * smooth_sky_towards(smooth_sky, direction_in_cell(normal, cells[k], places[i], k, seed));
#else
    sum += weights[k] * sky;
#endif
  }
  irradiance[i] = 3.14159265f * sum;
}
