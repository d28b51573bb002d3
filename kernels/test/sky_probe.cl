/* Probes of the lights that are infinitely far, for tests. */
#include "lights/sky_map.cl"
#include "lights/sun.cl"

#define OFFSET(type, field) ((uint)(size_t) & (((__private type*)0)->field))

/* One work-item: sizes and offsets of the shared structs as the device lays them out. */
__kernel void probe_sky_layout(__global uint* sizes) {
  sizes[0] = sizeof(SkyMap);
  sizes[1] = OFFSET(SkyMap, forward);
  sizes[2] = OFFSET(SkyMap, up);
  sizes[3] = sizeof(SkyRow);
  sizes[4] = sizeof(SkyTexel);
}

/* drawn[3 i] = (direction drawn by u[i], 0), drawn[3 i + 1] = texel that was drawn, drawn[3 i + 2] = texel in that direction. */
__kernel void probe_sky_map(__constant SkyMap* map, const __global SkyRow* rows, const __global float* columns,
                            const __global float4* texels, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Sky sky = {map, rows, columns, texels};
  float3 direction;
  drawn[3u * i + 1u] = sky_map_sample(sky, u[i], &direction);
  drawn[3u * i] = (float4)(direction, 0.0f);
  drawn[3u * i + 2u] = sky_map_towards(sky, direction);
}

/* found[i] = texel in directions[i] (xyz). */
__kernel void probe_sky_towards(__constant SkyMap* map, const __global SkyRow* rows, const __global float* columns,
                                const __global float4* texels, const __global float4* directions, __global float4* found,
                                uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Sky sky = {map, rows, columns, texels};
  found[i] = sky_map_towards(sky, directions[i].xyz);
}

/* drawn[3 i] = (direction drawn by u[i].xy, 0); its density and what the strength is multiplied by: drawn[3 i + 1] as drawn,
 * drawn[3 i + 2] as found in that direction. Where it was drawn the factor is radiance over density. */
__kernel void probe_sun(const __global LightSource* sun, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  float3 direction;
  float distance, pdf;
  const float factor = sun_sample(sun, (float3)(0.0f), u[i].xy, &direction, &distance, &pdf);
  drawn[3u * i] = (float4)(direction, 0.0f);
  drawn[3u * i + 1u] = (float4)(factor, 0.0f, 0.0f, pdf);
  const float radiance = sun_towards(sun, direction, &pdf);
  drawn[3u * i + 2u] = (float4)(radiance, 0.0f, 0.0f, pdf);
}
