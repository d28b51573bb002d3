/* What all kinds of material share: how a ray goes on from a surface. */
#include "materials/media.cl"
#include "traverse/traversal.cl"

#ifdef HAS_SPECULAR

/* A normal never lies flatter than this to the ray that meets it: near a silhouette the smooth normal may face away from a
 * ray that has met the disc's front. */
#define LEAST_FACING 1e-3f

typedef struct Scatter {
  float3 direction;
  float3 weight; /* of the light that the ray brings on, per colour: f cos / pdf */
  float pdf;     /* of the direction, per solid angle; 0: the direction is the only one */
  bool back;     /* the ray goes off on the surface's back side */
  bool through;  /* the ray came through the surface */
} Scatter;

/* The surface's normal on the ray's side. */
static inline float3 facing_normal(const Surface* s, float3 direction) {
  const float3 n = s->front ? s->normal : -s->normal;
  return normalize3(n - fmax(LEAST_FACING + dot3(n, direction), 0.0f) * direction);
}

#ifdef HAS_CONES
/* A lobe as the one cone that stands for it. */
typedef struct LobeCone {
  float3 direction; /* mirrored, unit */
  float3 weight;    /* of the mean radiance in the cone, per colour */
  float spread;     /* diameter over distance */
} LobeCone;

/* Spread of the cone about whose axis even light has the mean cosine of a Phong lobe of this exponent, 1 - 1 / (n + 2). Of
 * flat lobes that of a half angle of 60 degrees. */
static inline float phong_spread(float exponent) {
  const float height = fmin(2.0f / (exponent + 2.0f), 0.5f); /* 1 - cosine of the half angle */
  return 2.0f * sqrt(height * (2.0f - height)) / (1.0f - height);
}

#define NO_LOBE_CONE(name)                                                                                              \
  static inline LobeCone name##_cone(const Surface* s, const __global Material* material, float3 direction) {          \
    const LobeCone none = {s->normal, (float3)(0.0f), 0.0f};                                                            \
    return none;                                                                                                        \
  }
#else
#define NO_LOBE_CONE(name)
#endif

/* Kinds without a lobe: no sampled light is reflected to the viewer. */
#define NO_LOBE(name)                                                                                                   \
  static inline float3 name##_eval(const Surface* s, const __global Material* material, float3 direction,              \
                                   float3 towards, float* pdf) {                                                        \
    *pdf = 0.0f;                                                                                                        \
    return (float3)(0.0f);                                                                                              \
  }                                                                                                                   \
  NO_LOBE_CONE(name)
#endif
