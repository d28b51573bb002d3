/* Smooth interfaces: how much light a dielectric reflects, and where the rest goes. */
#include "lib/vector.cl"

/* Share of unpolarised light that a smooth dielectric reflects (Fresnel), from the cosine of incidence in (0, 1] and
 * eta = n_to / n_from. *cosine_t: of the refracted ray with the normal; 0 where all is reflected, at 1. */
static inline float fresnel_dielectric(float cosine, float eta, float* cosine_t) {
  const float sine2_t = (1.0f - cosine * cosine) / (eta * eta);
  if (sine2_t >= 1.0f) {
    *cosine_t = 0.0f;
    return 1.0f;
  }
  const float c = sqrt(1.0f - sine2_t);
  const float across = (cosine - eta * c) / (cosine + eta * c), along = (eta * cosine - c) / (eta * cosine + c);
  *cosine_t = c;
  return 0.5f * (across * across + along * along);
}

/* `direction` mirrored at the surface of unit normal n. */
static inline float3 reflect3(float3 direction, float3 n) { return normalize3(direction - 2.0f * dot3(direction, n) * n); }

/* Snell: `direction` bent at the surface of unit normal n, which faces it; cosine = -dot(direction, n), cosine_t and eta
 * as of fresnel_dielectric, which has found that something is let through. */
static inline float3 refract3(float3 direction, float3 n, float cosine, float cosine_t, float eta) {
  return normalize3((direction + cosine * n) / eta - cosine_t * n);
}

/* What is left of light after `length` in a medium (Beer's law); absorption per unit of length. */
static inline float3 beer(float3 absorption, float length) { return exp(-absorption * length); }
