/* A directional light: irradiance E cos. */
#include "lights/light_sample.cl"

/* As point_sample. */
static inline float directional_sample(const __global LightSource* light, float3 position, float2 u, float3* towards,
                                       float* distance, float* pdf) {
  *towards = load3(light->vector);
  *distance = INFINITY;
  *pdf = 0.0f;
  return 1.0f;
}

static inline PhotonOrigin directional_emit(const __global LightSource* light, float2 u) {
  const PhotonOrigin origin = {load3(light->vector), true, load3(light->strength)};
  return origin;
}
