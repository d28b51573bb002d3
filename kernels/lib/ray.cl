/* Rays and their hits. */
#include "lib/vector.cl"
#include "shared/traversal_types.h"

typedef struct Ray {
  float3 origin, direction; /* root cube; unit */
  float t_min, t_max;
#ifdef STEP_ABSOLUTE
  float step_delta;
#endif
} Ray;

typedef struct Hit {
  float t;    /* or the ray's t_max */
  uint splat; /* or NO_SPLAT */
} Hit;

/* Whether the ray's numbers are numbers. What is none of them would meet every box: fmin and fmax pass over NaN. */
static inline bool is_finite_ray(Ray ray) {
  return dot3(ray.origin, ray.origin) + dot3(ray.direction, ray.direction) < INFINITY;
}

/* The part of the ray in the root cube, widened by a little more than rounding, and inside [t_min, t_max]; false when
 * there is none. */
static inline bool ray_meets_root(Ray ray, float* t_enter, float* t_leave) {
  const float3 inverse = 1.0f / ray.direction;
  const float3 a = (-1e-6f - ray.origin) * inverse, b = (1.0f + 1e-6f - ray.origin) * inverse;
  const float3 t0 = fmin(a, b), t1 = fmax(a, b);
  *t_enter = fmax(fmax(t0.x, t0.y), fmax(t0.z, ray.t_min));
  *t_leave = fmin(fmin(t1.x, t1.y), fmin(t1.z, ray.t_max));
  return *t_enter <= *t_leave && is_finite_ray(ray);
}
