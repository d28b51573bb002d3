/* The sun: a disc of uniform radiance, infinitely far. */
#include "lib/sampling.cl"
#include "shared/sky_types.h"

/* What the sun's disc sends along a ray of that unit direction: its radiance [W/m2/sr, scaled] in xyz, in w the density [1/sr]
 * with which sun_disc_sample draws it; 0 beside the disc. By the chord: a cosine this near to 1 has no digits left. */
static inline float4 sun_disc_towards(SunDisc sun, float3 direction) {
  const float3 towards = (float3)(sun.towards[0], sun.towards[1], sun.towards[2]), chord = direction - towards;
  const float height = sun.sine2 / (1.0f + sqrt(1.0f - sun.sine2)); /* 1 - cosine of the angular radius */
  if (dot3(chord, chord) > 2.0f * height)
    return (float4)(0.0f);
  return (float4)(sun.radiance[0], sun.radiance[1], sun.radiance[2], 1.0f / sun.solid_angle);
}

/* A direction of the disc, uniform in solid angle, by two numbers in [0, 1). Returns what sun_disc_towards does there. */
static inline float4 sun_disc_sample(SunDisc sun, float2 u, float3* direction) {
  float solid_angle;
  *direction = cone_direction((float3)(sun.towards[0], sun.towards[1], sun.towards[2]), sun.sine2, u, &solid_angle);
  return (float4)(sun.radiance[0], sun.radiance[1], sun.radiance[2], 1.0f / solid_angle);
}
