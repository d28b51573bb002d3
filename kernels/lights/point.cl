/* A point light: irradiance I cos / d^2. */
#include "lights/light_sample.cl"

/* Direction and distance of the light from `position`; *pdf: 0, no ray meets a point. Returns what its strength is multiplied
 * by to give the irradiance of a surface that faces it. */
static inline float point_sample(const __global LightSource* light, float3 position, float2 u, float3* towards,
                                 float* distance, float* pdf) {
  *towards = load3(light->vector) - position;
  /* A light on the surface itself: finite, and nobody can say which side it is on. */
  const float d2 = fmax(dot3(*towards, *towards), 1e-12f);
  *distance = sqrt(d2);
  *towards /= *distance;
  *pdf = 0.0f;
  return 1.0f / d2;
}

static inline PhotonOrigin point_emit(const __global LightSource* light, float2 u) {
  const PhotonOrigin origin = {load3(light->vector), false, load3(light->strength)};
  return origin;
}
