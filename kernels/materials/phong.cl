/* The specular lobe of the modified Phong model (Lafortune and Willems, "Using the Modified Phong Reflectance Model for
 * Physically Based Rendering", 1994): f = specular (n + 2) / (2 pi) cos^n a, a being the angle to the mirrored direction.
 * The lobe reflects no more than `specular` of what comes in from any direction. */
#include "materials/fresnel.cl"
#include "materials/scatter.cl"

#if WITH_PHONG
/* 1 / (2 pi). */
#define PHONG_NORMALISATION 0.15915494f

/* f / specular, from cos a. */
static inline float phong_lobe(float cosine, float exponent) {
  return cosine > 0.0f ? (exponent + 2.0f) * PHONG_NORMALISATION * pow(cosine, exponent) : 0.0f;
}

/* Density of phong_direction, (n + 1) / (2 pi) cos^n a. */
static inline float phong_density(float cosine, float exponent) {
  return cosine > 0.0f ? (exponent + 1.0f) * PHONG_NORMALISATION * pow(cosine, exponent) : 0.0f;
}

/* A direction about `mirrored`. cos a = (1 - u)^(1 / (n + 1)) is so near 1 for large exponents that a float holds few of its
 * values: 1 - cos a comes from expm1 and log1p, and the sine from that. */
static inline float3 phong_direction(float3 mirrored, float exponent, float u, float v) {
  float3 a, b;
  tangents(mirrored, &a, &b);
  const float down = -expm1(log1p(-u) / (exponent + 1.0f)), phi = 6.2831853f * v;
  const float sine = sqrt(fmax(0.0f, down * (2.0f - down)));
  return normalize3(sine * cos(phi) * a + sine * sin(phi) * b + (1.0f - down) * mirrored);
}

/* f cos / density / specular of such a direction, from its cosine with the surface's normal; 0 below the surface. */
static inline float phong_weight(float cosine, float exponent) {
  return (exponent + 2.0f) / (exponent + 1.0f) * fmax(cosine, 0.0f);
}

#ifdef HAS_SPECULAR
/* From the front; false where the ray ends. */
static inline bool phong_sample(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                                Media* media, Scatter* out) {
  const __global Material* material = materials + s->material;
  const float3 n = facing_normal(s, direction), mirrored = reflect3(direction, n);
  out->direction = phong_direction(mirrored, material->exponent, u.x, u.y);
  const float cosine = dot3(out->direction, n);
  out->weight = load3(material->specular) * phong_weight(cosine, material->exponent);
  out->pdf = phong_density(dot3(out->direction, mirrored), material->exponent);
  out->back = out->through = false;
  return s->front && cosine > 0.0f;
}

/* f for light from `towards` that leaves against `direction`; *pdf: density with which phong_sample would have chosen it. */
static inline float3 phong_eval(const Surface* s, const __global Material* material, float3 direction, float3 towards,
                                float* pdf) {
  const float cosine = dot3(towards, reflect3(direction, facing_normal(s, direction)));
  *pdf = phong_density(cosine, material->exponent);
  return load3(material->specular) * phong_lobe(cosine, material->exponent);
}

#ifdef HAS_CONES
static inline LobeCone phong_cone(const Surface* s, const __global Material* material, float3 direction) {
  const float3 n = facing_normal(s, direction);
  LobeCone cone;
  cone.direction = reflect3(direction, n);
  cone.weight = load3(material->specular) * phong_weight(dot3(cone.direction, n), material->exponent);
  cone.spread = phong_spread(material->exponent);
  return cone;
}
#endif
#endif
#endif
