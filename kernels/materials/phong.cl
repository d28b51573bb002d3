/* The specular lobe of the modified Phong model (Lafortune and Willems, "Using the Modified Phong Reflectance Model for
 * Physically Based Rendering", 1994): f = specular (n + 2) / (2 pi) cos^n a, a being the angle to the mirrored direction;
 * it gives back no more than `specular` of what comes in, from no direction. */
#include "materials/fresnel.cl"

/* f / specular, from cos a. */
static inline float phong_lobe(float cosine, float exponent) {
  return cosine > 0.0f ? (exponent + 2.0f) * 0.15915494f * pow(cosine, exponent) : 0.0f;
}

/* A direction about `mirrored`, density (n + 1) / (2 pi) cos^n a. */
static inline float3 phong_direction(float3 mirrored, float exponent, float u, float v) {
  float3 a, b;
  tangents(mirrored, &a, &b);
  const float cosine = pow(1.0f - u, 1.0f / (exponent + 1.0f)), phi = 6.2831853f * v;
  const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
  return normalize3(sine * cos(phi) * a + sine * sin(phi) * b + cosine * mirrored);
}

/* f cos / density / specular of such a direction, from its cosine with the surface's normal; 0 below the surface. */
static inline float phong_weight(float cosine, float exponent) {
  return (exponent + 2.0f) / (exponent + 1.0f) * fmax(cosine, 0.0f);
}
