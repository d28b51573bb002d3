/* Light that reaches a surface straight from its source, by shadow rays.
 *   HAS_DELTA_LIGHTS, HAS_EMITTERS, HAS_ENVIRONMENT  where the scene may have such lights; on CPU devices only where it has */
#include "materials/phong.cl"
#include "lib/sampling.cl"
#include "traverse/traversal.cl"

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

/* A place or direction from which light may come, and what it adds to the irradiance when nothing is in between. */
typedef struct LightSample {
  float3 towards; /* unit */
  float distance;
  float3 irradiance;
  float3 normal; /* of the emitting disc; 0 where the light is none, as its radius */
  float radius;
} LightSample;

/* Rays off a surface start a little behind it: where two walls meet, rounding may put the point a few float steps beyond
 * the other wall, and light would leak in along the edge. The surface itself does not count (ShadowEnds). */
#define BEHIND_SURFACE -4e-6f

/* Whether nothing stands between the surface and the light; counts its ray. */
static inline bool in_light(POOL_PARAMS, const Surface* s, const LightSample* light, float step_delta, float* rays) {
  Ray ray;
  ray.origin = s->position;
  ray.direction = light->towards;
  ray.t_min = BEHIND_SURFACE;
  ray.t_max = light->distance;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  const ShadowEnds ends = {s->normal, light->normal, s->radius, light->radius};
  *rays += 1.0f;
  return !trace_any(POOL_ARGS, ray, ends);
}

/* The samplers below return false when the light does not reach the surface's front whatever stands between. */

#ifdef HAS_DELTA_LIGHTS
/* Irradiance of one point light, I cos / d^2, or directional light, E cos. Of more than ALL_DELTA_LIGHTS one is drawn,
 * else it is number i. */
static inline bool sample_delta_light(const Surface* s, Lights lights, float4 u, uint i, LightSample* sample) {
  const uint count = lights.params->delta_lights;
  float share = 1.0f;
  if (count > ALL_DELTA_LIGHTS) {
    i = pick(&lights.delta->cumulative, sizeof(DeltaLight) / sizeof(float), count, u.x);
    share = lights.delta[i].cumulative - (i > 0u ? lights.delta[i - 1u].cumulative : 0.0f);
  }
  const __global DeltaLight* light = lights.delta + i;
  float3 towards = load3(light->vector);
  float falloff = 1.0f;
  sample->distance = INFINITY;
  if (light->type == LIGHT_POINT) {
    towards -= s->position;
    /* A light on the surface itself: finite, and nobody can say which side it is on. */
    const float d2 = fmax(dot3(towards, towards), 1e-12f);
    sample->distance = sqrt(d2);
    towards /= sample->distance;
    falloff = 1.0f / d2;
  }
  const float cosine = dot3(s->normal, towards);
  sample->towards = towards;
  sample->irradiance = load3(light->strength) * (cosine * falloff) / share;
  sample->normal = (float3)(0.0f);
  sample->radius = 0.0f;
  return cosine > 0.0f;
}
#endif

#ifdef HAS_EMITTERS
/* One emitting splat in proportion to its power, one point on the disc of its effective area: H = L A cos cos' / (d^2 p). */
static inline bool sample_emitter(POOL_PARAMS, const Surface* s, Lights lights, float4 u, LightSample* sample) {
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
  sample->distance = sqrt(d2);
  towards /= sample->distance;
  const float cosine = dot3(s->normal, towards), cosine_at_light = -dot3(normal.xyz, towards);
  sample->towards = towards;
  sample->irradiance =
      load3(lights.materials[(uint)normal.w].emission) * (area * cosine * cosine_at_light / (d2 * share));
  sample->normal = normal.xyz;
  sample->radius = centre.w;
  return share > 0.0f && cosine > 0.0f && cosine_at_light > 0.0f;
}
#endif

#ifdef HAS_ENVIRONMENT
static inline bool sample_environment(const Surface* s, Lights lights, float4 u, LightSample* sample) {
  sample->towards = cosine_direction(s->normal, u.x, u.y);
  sample->distance = INFINITY;
  sample->irradiance = load3_constant(lights.params->environment) * 3.14159265f; /* cos / (cos/pi) */
  sample->normal = (float3)(0.0f);
  sample->radius = 0.0f;
  return true;
}
#endif

/* Irradiance H [W/m2, scaled] of the surface from all lights, one estimate; the mean over samples converges to it.
 * Adds the number of shadow rays traced to *rays. One place traces them all: the walk stands once in the code, and
 * work-items that shade different lights walk together. Where there are Phong surfaces, s->highlight grows by what their
 * lobe makes of point and directional lights, which no ray that it sends out can meet. */
static inline float3 direct_irradiance(POOL_PARAMS, Surface* s, Lights lights, SampleId id, float* rays) {
  float3 sum = (float3)(0.0f);
  uint delta_samples = 0u, emitter_samples = 0u, environment_samples = 0u;
#ifdef HAS_DELTA_LIGHTS
  delta_samples = lights.params->delta_lights <= ALL_DELTA_LIGHTS ? lights.params->delta_lights : 1u;
#endif
#ifdef HAS_EMITTERS
  emitter_samples = lights.params->emitters > 0u ? 1u : 0u;
#endif
#ifdef HAS_ENVIRONMENT
  const float3 sky = load3_constant(lights.params->environment);
  environment_samples = sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f ? 1u : 0u;
#endif
  for (uint i = 0u; i < delta_samples + emitter_samples + environment_samples; ++i) {
    const float4 u = stratified4(id, i < delta_samples ? 1u : i < delta_samples + emitter_samples ? 2u : 3u);
    LightSample light;
    bool faces = false;
#ifdef HAS_DELTA_LIGHTS
    if (i < delta_samples)
      faces = sample_delta_light(s, lights, u, i, &light);
#endif
#ifdef HAS_EMITTERS
    if (i == delta_samples)
      faces = sample_emitter(POOL_ARGS, s, lights, u, &light);
#endif
#ifdef HAS_ENVIRONMENT
    if (i == delta_samples + emitter_samples)
      faces = sample_environment(s, lights, u, &light);
#endif
    if (faces && in_light(POOL_ARGS, s, &light, lights.params->step_delta, rays)) {
      sum += light.irradiance;
#ifdef HAS_PHONG
      if (i < delta_samples)
        s->highlight += light.irradiance * phong_lobe(dot3(light.towards, s->mirrored), s->exponent);
#endif
    }
  }
  return sum;
}
