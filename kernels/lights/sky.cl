/* The environment: light from infinitely far, all around. The same radiance from every direction, which is drawn by the cosine;
 * or a map (HAS_SKY_MAP), from which two samples are taken, one as bright texels are distributed and one by the cosine. They
 * are combined by the balance heuristic: the first alone is noisy where the map is about even, the second where it has a sun. */
#include "lights/light_sample.cl"

#ifdef HAS_SKY_MAP
#define SKY_SAMPLES 2u
#else
#define SKY_SAMPLES 1u
#endif

/* What rays in one direction find. */
typedef struct SkyLight {
  float3 radiance;
  float pdf; /* sum over the samples of the densities [1/sr] with which they are drawn there */
} SkyLight;

/* Density, per solid angle, of a direction drawn by the cosine at a surface of unit normal n. */
static inline float sky_cosine_pdf(float3 n, float3 direction) { return fmax(dot3(n, direction), 0.0f) * 0.31830989f; }

/* `cosine_pdf`: sky_cosine_pdf of the surface that samples the sky; where that is 0 it takes no light from there. */
static inline SkyLight sky_light(Lights lights, float3 direction, float cosine_pdf) {
#ifdef HAS_SKY_MAP
  const float4 texel = sky_map_towards(lights.sky, direction);
  const SkyLight light = {texel.xyz, cosine_pdf > 0.0f ? cosine_pdf + texel.w : 0.0f};
#else
  const SkyLight light = {load3_constant(lights.params->environment), cosine_pdf};
#endif
  return light;
}

/* Sample `number` of SKY_SAMPLES; the sum of their irradiances is the estimate. False where the direction is behind the surface. */
static inline bool sample_sky(const Surface* s, Lights lights, float4 u, uint number, LightSample* sample) {
  sample->distance = INFINITY;
  sample->normal = (float3)(0.0f);
  sample->radius = 0.0f;
#ifdef HAS_SKY_MAP
  float4 texel;
  if (number == 0u) {
    texel = sky_map_sample(lights.sky, u, &sample->towards);
  } else {
    sample->towards = cosine_direction(s->normal, u.x, u.y);
    texel = sky_map_towards(lights.sky, sample->towards);
  }
  const float cosine = dot3(s->normal, sample->towards);
  const float pdf = texel.w + cosine * 0.31830989f;
  sample->irradiance = texel.xyz * (cosine / pdf);
#ifdef HAS_LOBES
  sample->pdf = pdf;
#endif
  return cosine > 0.0f && texel.w > 0.0f; /* what is never drawn from the map is black */
#else
  sample->towards = cosine_direction(s->normal, u.x, u.y);
  sample->irradiance = load3_constant(lights.params->environment) * 3.14159265f; /* cos / (cos/pi) */
#ifdef HAS_LOBES
  sample->pdf = dot3(s->normal, sample->towards) * 0.31830989f;
#endif
  return true;
#endif
}
