/* Mirror, glass and Phong surfaces: how a ray goes on from the blended surface that it has met (method.md section 6). The
 * same for light that is looked for from the eye and for light that is sent out, but for the way in which it runs.
 *   HAS_SPECULAR  some material is no diffuse one
 *   HAS_GLASS     some is glass
 *   HAS_PHONG     some is Phong's
 * A ray's life: `hit` is traced; media_before says what glass it came through, beer_of what that left of it; the surface
 * scatters it; scattered_ray and scattered_ends are what is traced next. */
#include "materials/media.cl"
#include "materials/phong.cl"
#include "traverse/traversal.cl"

#ifdef HAS_SPECULAR

/* Rays off a surface start a little behind it (kernels/lights/lights.cl). */
#define SCATTER_T_MIN(radius) (-SEGMENT_MARGIN(radius))

/* A normal never lies flatter than this to the ray that meets it: near a silhouette the smooth normal may face away from a
 * ray that has met the disc's front. */
#define LEAST_FACING 1e-3f

typedef struct Scatter {
  float3 direction;
  float3 weight; /* of the light it brings on, per colour */
  bool back;     /* it goes off on the surface's back side */
  bool through;  /* it came through the surface */
} Scatter;

/* The surface's normal on the ray's side. */
static inline float3 facing_normal(const Surface* s, float3 direction) {
  const float3 n = s->front ? s->normal : -s->normal;
  return normalize3(n - fmax(LEAST_FACING + dot3(n, direction), 0.0f) * direction);
}

/* A mirror, from its front; false where the ray ends. */
static inline bool scatter_mirror(const Surface* s, const __global Material* material, float3 direction, Scatter* out) {
  out->direction = reflect3(direction, facing_normal(s, direction));
  out->weight = load3(material->specular);
  out->back = out->through = false;
  return s->front;
}

/* What glass the ray was in on its way to the surface; see kernels/materials/media.cl. */
static inline Media media_before(Media media, const Surface* s, const __global Material* materials) {
#ifdef HAS_GLASS
  if (materials[s->material].type == MATERIAL_GLASS)
    return s->front ? without_medium(media, s->material) : within_medium(media, s->material);
#endif
  return media;
}

#ifdef HAS_GLASS

/* Glass, from either side: reflected with the probability of its Fresnel reflectance (u in [0,1) decides), else let
 * through; all of the light goes the way that is chosen. Radiance is carried divided by the index of refraction squared,
 * as glass leaves it: what lies inside glass looks as if behind a thin gap of air. `media`: before; becomes that behind. */
static inline void scatter_glass(const Surface* s, const __global Material* materials, float3 direction, float u,
                                 Media* media, Scatter* out) {
  const float3 n = facing_normal(s, direction);
  const Media beyond = s->front ? within_medium(*media, s->material) : without_medium(*media, s->material);
  const float cosine = fmin(-dot3(direction, n), 1.0f), eta = ior_of(beyond, materials) / ior_of(*media, materials);
  float cosine_t;
  const bool reflected = u < fresnel_dielectric(cosine, eta, &cosine_t);
  out->direction = reflected ? reflect3(direction, n) : refract3(direction, n, cosine, cosine_t, eta);
  out->weight = (float3)(1.0f);
  out->back = reflected != s->front;
  out->through = !reflected;
  if (!reflected)
    *media = beyond;
}
#endif

#ifdef HAS_PHONG
/* The specular lobe of a Phong surface, from its front; false where the ray ends. */
static inline bool scatter_phong(const Surface* s, const __global Material* material, float3 direction, float u, float v,
                                 Scatter* out) {
  const float3 n = facing_normal(s, direction);
  out->direction = phong_direction(reflect3(direction, n), material->exponent, u, v);
  const float cosine = dot3(out->direction, n);
  out->weight = load3(material->specular) * phong_weight(cosine, material->exponent);
  out->back = out->through = false;
  return s->front && cosine > 0.0f;
}
#endif

/* What the surface makes of the ray, u in [0,1)^2 deciding: mirror, glass, or the lobe of a Phong surface. False where the
 * ray ends: on a diffuse surface, and on backs of all but glass. */
static inline bool scatter_ray(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                               Media* media, Scatter* out) {
  const __global Material* material = materials + s->material;
#ifdef HAS_GLASS
  if (material->type == MATERIAL_GLASS) {
    scatter_glass(s, materials, direction, u.x, media, out);
    return true;
  }
#endif
#ifdef HAS_PHONG
  if (material->type == MATERIAL_PHONG)
    return scatter_phong(s, material, direction, u.x, u.y, out);
#endif
  return material->type == MATERIAL_MIRROR && scatter_mirror(s, material, direction, out);
}

/* The ray that goes on. */
static inline Ray scattered_ray(const Surface* s, const Scatter* scatter, float step_delta) {
  Ray ray;
  ray.origin = s->position;
  ray.direction = scatter->direction;
  ray.t_min = SCATTER_T_MIN(s->radius);
  ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  return ray;
}

/* The surface that it leaves, for trace_closest_from and blended_surface. */
static inline ShadowEnds scattered_ends(const Surface* s, const Scatter* scatter, Media media) {
  ShadowEnds ends = free_ends();
  ends.origin_normal = s->normal;
  ends.origin_radius = s->radius;
  ends.origin_material = s->material + 1u;
  ends.origin_back = scatter->back ? 1u : 0u;
  ends.origin_through = scatter->through ? 1u : 0u;
  ends.medium = media.x + 1u; /* NO_MEDIUM: 0 */
  return ends;
}
#endif
