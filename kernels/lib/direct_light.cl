/* Light that reaches a surface straight from its source, by shadow rays.
 *   HAS_DELTA_LIGHTS, HAS_EMITTERS, HAS_ENVIRONMENT  defined only where the scene has such lights */
#include "lib/sampling.cl"
#include "lib/traversal.cl"

/* Up to this many point and directional lights are all asked for every ray; of more, one, drawn in proportion to its
 * strength. */
#define ALL_DELTA_LIGHTS 4u

typedef struct Lights {
  __constant RenderParams* params;
  const __global Material* materials;
  const __global DeltaLight* delta;
  const __global Emitter* emitters;
} Lights;

/* Index of the first entry whose cumulative share exceeds u, for entries `stride` floats apart. */
static inline uint pick(const __global float* cumulative, uint stride, uint count, float u) {
  uint low = 0u, high = count - 1u;
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (cumulative[middle * stride] > u)
      high = middle;
    else
      low = middle + 1u;
  }
  return low;
}

/* One shadow ray from the surface towards `direction` (unit), over `distance`; counts itself. */
static inline bool in_light(POOL_PARAMS, const Surface* s, float3 direction, float distance, float3 target_normal,
                     float target_radius, float step_delta, float* rays) {
  Ray ray;
  ray.origin = s->position;
  ray.direction = direction;
  /* A little behind the surface: where two walls meet, rounding may put the point a few float steps beyond the other
   * wall, and light would leak in along the edge. The surface itself does not count (ShadowEnds). */
  ray.t_min = -4e-6f;
  ray.t_max = distance;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  const ShadowEnds ends = {s->normal, target_normal, s->radius, target_radius};
  *rays += 1.0f;
  return !trace_any(POOL_ARGS, ray, ends);
}

#ifdef HAS_DELTA_LIGHTS
/* Irradiance of one point light, I cos / d^2, or directional light, E cos. */
static inline float3 irradiance_of_delta_light(POOL_PARAMS, const Surface* s, const __global DeltaLight* light,
                                        float step_delta, float* rays) {
  float3 towards = load3(light->vector);
  float distance = INFINITY, falloff = 1.0f;
  if (light->type == LIGHT_POINT) {
    towards -= s->position;
    /* A light on the surface itself: finite, and nobody can say which side it is on. */
    const float d2 = fmax(dot3(towards, towards), 1e-12f);
    distance = sqrt(d2);
    towards /= distance;
    falloff = 1.0f / d2;
  }
  const float cosine = dot3(s->normal, towards);
  if (cosine <= 0.0f || !in_light(POOL_ARGS, s, towards, distance, (float3)(0.0f), 0.0f, step_delta, rays))
    return (float3)(0.0f);
  return load3(light->strength) * (cosine * falloff);
}
#endif

/* Irradiance H [W/m2, scaled] of the surface from all lights, one estimate; the mean over samples converges to it.
 * Adds the number of shadow rays traced to *rays. */
static inline float3 direct_irradiance(POOL_PARAMS, const Surface* s, Lights lights, SampleId id, float* rays) {
  float3 sum = (float3)(0.0f);
  const float step_delta = lights.params->step_delta;
#ifdef HAS_DELTA_LIGHTS
  const uint count = lights.params->delta_lights;
  if (count <= ALL_DELTA_LIGHTS) {
    for (uint i = 0u; i < count; ++i)
      sum += irradiance_of_delta_light(POOL_ARGS, s, lights.delta + i, step_delta, rays);
  } else {
    const float u = stratified4(id, 1u).x;
    const uint i = pick(&lights.delta->cumulative, sizeof(DeltaLight) / sizeof(float), count, u);
    const float share = lights.delta[i].cumulative - (i > 0u ? lights.delta[i - 1u].cumulative : 0.0f);
    sum += irradiance_of_delta_light(POOL_ARGS, s, lights.delta + i, step_delta, rays) / share;
  }
#endif
#ifdef HAS_EMITTERS
  {
    /* One emitting splat in proportion to its power, one point on the disc of its effective area:
     * H = L A cos cos' / (d^2 p). */
    const float4 u = stratified4(id, 2u);
    const uint i = pick(&lights.emitters->cumulative, sizeof(Emitter) / sizeof(float), lights.params->emitters, u.x);
    const float share = lights.emitters[i].cumulative - (i > 0u ? lights.emitters[i - 1u].cumulative : 0.0f);
    const uint point = lights.emitters[i].point;
    const float4 centre = pool_point_texel(POINT_TEXELS * point);
    const float4 normal = pool_point_texel(POINT_TEXELS * point + 1u);
    const float area = pool_point_texel(POINT_TEXELS * point + 2u).w;
    float3 a, b;
    tangents(normal.xyz, &a, &b);
    const float r = sqrt(u.z * area * 0.31830989f), phi = 6.2831853f * u.w;
    float3 towards = centre.xyz + r * cos(phi) * a + r * sin(phi) * b - s->position;
    /* Not nearer than a tenth of the disc: the estimate of a light that touches the surface stays finite. */
    const float d2 = fmax(dot3(towards, towards), 0.01f * area);
    const float distance = sqrt(d2);
    towards /= distance;
    const float cosine = dot3(s->normal, towards), cosine_at_light = -dot3(normal.xyz, towards);
    if (share > 0.0f && cosine > 0.0f && cosine_at_light > 0.0f &&
        in_light(POOL_ARGS, s, towards, distance, normal.xyz, centre.w, step_delta, rays))
      sum += load3(lights.materials[(uint)normal.w].emission) * (area * cosine * cosine_at_light / (d2 * share));
  }
#endif
#ifdef HAS_ENVIRONMENT
  {
    const float4 u = stratified4(id, 3u);
    const float3 towards = cosine_direction(s->normal, u.x, u.y);
    if (in_light(POOL_ARGS, s, towards, INFINITY, (float3)(0.0f), 0.0f, step_delta, rays))
      sum += load3_constant(lights.params->environment) * 3.14159265f; /* cos / (cos/pi) */
  }
#endif
  return sum;
}
