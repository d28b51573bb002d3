/* The environment: the same radiance from every direction. */
#include "lights/light_sample.cl"

/* Drawn by the cosine: H = L pi. */
static inline bool sample_sky(const Surface* s, __constant RenderParams* params, float4 u, LightSample* sample) {
  sample->towards = cosine_direction(s->normal, u.x, u.y);
  sample->distance = INFINITY;
  sample->irradiance = load3_constant(params->environment) * 3.14159265f; /* cos / (cos/pi) */
  sample->normal = (float3)(0.0f);
  sample->radius = 0.0f;
#ifdef HAS_LOBES
  sample->pdf = dot3(s->normal, sample->towards) * 0.31830989f;
#endif
  return true;
}

/* Density, per solid angle, with which sample_sky chooses `direction` at a surface of unit normal n. */
static inline float sky_pdf(float3 n, float3 direction) { return fmax(dot3(n, direction), 0.0f) * 0.31830989f; }

static inline float3 sky_radiance(__constant RenderParams* params, float3 direction) {
  return load3_constant(params->environment);
}
