/* Rays, hits, and which hits of a shadow ray belong to the surfaces at its two ends. */
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

/* The part of the ray in the root cube, widened by a little more than rounding, and inside [t_min, t_max]; false when
 * there is none. */
static inline bool ray_meets_root(Ray ray, float* t_enter, float* t_leave) {
  const float3 inverse = 1.0f / ray.direction;
  const float3 a = (-1e-6f - ray.origin) * inverse, b = (1.0f + 1e-6f - ray.origin) * inverse;
  const float3 t0 = fmin(a, b), t1 = fmax(a, b);
  *t_enter = fmax(fmax(t0.x, t0.y), fmax(t0.z, ray.t_min));
  *t_leave = fmin(fmin(t1.x, t1.y), fmin(t1.z, ray.t_max));
  return *t_enter <= *t_leave;
}

typedef struct ShadowEnds {
  float3 origin_normal, target_normal; /* facing the ray or not: the side does not matter, the splat's own normal does */
  float origin_radius, target_radius;  /* 0: no surface at that end (a point light, the environment) */
} ShadowEnds;

static inline bool belongs_to_ends(ShadowEnds ends, float t_max, float t, float radius, float3 normal) {
  const float origin_cosine = dot3(normal, ends.origin_normal), target_cosine = dot3(normal, ends.target_normal);
  const float before = t_max - t;
  return (t < SELF_HIT_REACH * (ends.origin_radius + radius) && origin_cosine > SELF_HIT_COSINE) ||
         (before < SELF_HIT_REACH * (ends.target_radius + radius) && target_cosine > SELF_HIT_COSINE) ||
         (t < COINCIDENT && origin_cosine < -SELF_HIT_COSINE) ||
         (before < COINCIDENT && target_cosine < -SELF_HIT_COSINE);
}
