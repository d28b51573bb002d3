/* The sun: a disc of uniform radiance, infinitely far. Its strength is the irradiance E of a surface across its beam, its radiance
 * E / (pi sine2), as pi sine2 is the integral of the cosine over the disc. */
#include "lights/light_sample.cl"

#define SUN_CROSS_SECTION(light) (3.14159265f * (light)->sine2)

/* As point_sample; a direction of the disc, uniform in solid angle. */
static inline float sun_sample(const __global LightSource* light, float3 position, float2 u, float3* towards, float* distance,
                               float* pdf) {
  float solid_angle;
  *towards = cone_direction(load3(light->vector), light->sine2, u, &solid_angle);
  *distance = INFINITY;
  *pdf = 1.0f / solid_angle;
  return solid_angle / SUN_CROSS_SECTION(light);
}

static inline PhotonOrigin sun_emit(const __global LightSource* light, float2 u) {
  float solid_angle;
  const float3 towards = cone_direction(load3(light->vector), light->sine2, u, &solid_angle);
  const PhotonOrigin origin = {towards, true, load3(light->strength) * (solid_angle / SUN_CROSS_SECTION(light))};
  return origin;
}

/* What its strength is multiplied by to give the radiance along a ray of that unit direction, and the density [1/sr] with which
 * sun_sample draws it; 0 beside the disc. By the chord: a cosine this near to 1 has no digits left. */
static inline float sun_towards(const __global LightSource* light, float3 direction, float* pdf) {
  const float3 chord = direction - load3(light->vector);
  const float height = light->sine2 / (1.0f + sqrt(1.0f - light->sine2)); /* 1 - cosine of the angular radius */
  const bool meets = dot3(chord, chord) <= 2.0f * height;
  *pdf = meets ? 1.0f / (6.2831853f * height) : 0.0f;
  return meets ? 1.0f / SUN_CROSS_SECTION(light) : 0.0f;
}
