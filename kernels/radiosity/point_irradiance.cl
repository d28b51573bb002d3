/* Direct irradiance of the points themselves: what the lights put into the exchange of diffuse light (method.md §4).
 * NDRange: 1-D, one work-item a point, padded; the work-item i has point places[first + i] of the pool, if below `end`, and
 * writes irradiance[3 places[first + i] ...], three scalars [W/m2, scaled as RenderParams], the mean of `samples`
 * estimates. */
#include "lights/lights.cl"

/* The front side of a point's own disc, at its middle. */
static inline Surface surface_of_point(POOL_PARAMS, uint point) {
  const float4 centre = pool_point_texel(POINT_TEXELS * point), normal = pool_point_texel(POINT_TEXELS * point + 1u);
  Surface s;
  s.position = centre.xyz;
  s.normal = normal.xyz;
  s.albedo = pool_point_texel(POINT_TEXELS * point + 2u).xyz;
  s.t = 0.0f;
  s.radius = centre.w;
  s.splat = point;
  s.material = (uint)normal.w;
  s.front = true;
  return s;
}

__kernel OWN_VECTORS void direct_irradiance_of_points(POOL_PARAMS, LIGHT_PARAMS, const __global uint* places, __global float* irradiance,
                                          uint first, uint end, uint samples) {
  const uint i = first + get_global_id(0);
  if (i >= end)
    return;
  const uint point = places[i];
  float3 sum = (float3)(0.0f);
#if defined(HAS_LIGHT_SOURCES) || defined(HAS_EMITTERS) || defined(HAS_ENVIRONMENT)
  const Lights lights = {LIGHT_ARGS};
  Surface surface = surface_of_point(POOL_ARGS, point);
  float rays = 0.0f;
  for (uint k = 0u; k < samples; ++k) {
    /* A point takes the place of a pixel in the random numbers; 0x40000000 keeps it apart from the picture's. */
    const SampleId id = {(uint2)(point, 0x40000000u), k, params->seed};
    sum += direct_irradiance(POOL_ARGS, &surface, lights, id, viewed_by(-surface.normal, 0.0f), &rays);
  }
#endif
  irradiance[3u * point] = sum.x / (float)samples;
  irradiance[3u * point + 1u] = sum.y / (float)samples;
  irradiance[3u * point + 2u] = sum.z / (float)samples;
}
