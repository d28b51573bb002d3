/* Which surface scatters which way: the kinds that are compiled in (method.md section 6). The same for light that is looked
 * for from the eye and for light that is sent out, but for the way in which it runs.
 *   HAS_SPECULAR      some material is not only diffuse
 *   WITH_<ID>         of each kind of shared/material_kinds.h: 1 where the scene has it, else 0
 *   HAS_TRANSMISSION  some kind lets light through
 *   HAS_LOBES         some kind has a lobe
 * A ray's life: `hit` is traced; media_before says what glass it came through, beer_of what that left of it; the surface
 * scatters it; scattered_ray and scattered_ends are what is traced next. */
#include "materials/conductor.cl"
#include "materials/diffuse.cl"
#include "materials/glass.cl"
#include "materials/mirror.cl"
#include "materials/phong.cl"

static inline bool has_flag(const __global Material* material, uint flag) { return (material->flags & flag) != 0u; }

#ifdef HAS_SPECULAR

/* Rays off a surface start a little behind it (kernels/lights/lights.cl). */
#define SCATTER_T_MIN(radius) (-SEGMENT_MARGIN(radius))

/* What glass the ray was in on its way to the surface; see kernels/materials/media.cl. */
static inline Media media_before(Media media, const Surface* s, const __global Material* materials) {
#ifdef HAS_TRANSMISSION
  if (has_flag(materials + s->material, MATERIAL_TRANSMITS))
    return s->front ? without_medium(media, s->material) : within_medium(media, s->material);
#endif
  return media;
}

/* FOR_KIND_1(ID, name) is the code of a kind that is compiled in, FOR_KIND_0 that of one that is not. */
#define FOR_KIND(with, ID, name) FOR_KIND_(with, ID, name)
#define FOR_KIND_(with, ID, name) FOR_KIND_##with(ID, name)
#define FOR_KIND_0(ID, name)
#define SAMPLE_KIND(ID, name) FOR_KIND(WITH_##ID, ID, name)

/* What the surface makes of the ray, u in [0,1)^2 deciding. False where the ray ends: on a diffuse surface, and on backs of
 * all that does not transmit. */
static inline bool scatter_ray(const Surface* s, const __global Material* materials, float3 direction, float2 u,
                               Media* media, Scatter* out) {
#define FOR_KIND_1(ID, name)                        \
  if (materials[s->material].type == MATERIAL_##ID) \
    return name##_sample(s, materials, direction, u, media, out);
  MATERIAL_KINDS(SAMPLE_KIND)
#undef FOR_KIND_1
  return false;
}

#ifdef HAS_LOBES
/* The lobe's f for light from `towards` that leaves against `direction`; *pdf: density per solid angle with which scatter_ray
 * would have chosen `towards`. 0 and 0 of kinds without a lobe. */
static inline float3 eval_lobe(const Surface* s, const __global Material* material, float3 direction, float3 towards,
                               float* pdf) {
#define FOR_KIND_1(ID, name)           \
  if (material->type == MATERIAL_##ID) \
    return name##_eval(s, material, direction, towards, pdf);
  MATERIAL_KINDS(SAMPLE_KIND)
#undef FOR_KIND_1
  *pdf = 0.0f;
  return (float3)(0.0f);
}
#endif

#if defined(HAS_CONES) && defined(HAS_LOBES)
/* The lobe of a surface as a cone. */
static inline LobeCone lobe_cone(const Surface* s, const __global Material* material, float3 direction) {
#define FOR_KIND_1(ID, name)           \
  if (material->type == MATERIAL_##ID) \
    return name##_cone(s, material, direction);
  MATERIAL_KINDS(SAMPLE_KIND)
#undef FOR_KIND_1
  const LobeCone none = {s->normal, (float3)(0.0f), 0.0f};
  return none;
}
#endif

/* Probability that a path, or a photon, takes the specular part of a surface rather than the diffuse one: by their largest
 * reflectances. */
static inline float specular_probability(const Surface* s, const __global Material* material) {
  if (!has_flag(material, MATERIAL_SPECULAR))
    return 0.0f;
  if (!has_flag(material, MATERIAL_REFLECTS_DIFFUSELY))
    return 1.0f;
  const float3 specular = load3(material->specular);
  const float of_specular = fmax(fmax(specular.x, specular.y), specular.z);
  return of_specular / fmax(fmax(fmax(s->albedo.x, s->albedo.y), s->albedo.z) + of_specular, 1e-30f);
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

/* The surface that the ray leaves, for trace_closest_from and blended_surface. */
static inline OcclusionEnds scattered_ends(const Surface* s, const Scatter* scatter, Media media) {
  OcclusionEnds ends = free_ends();
  ends.origin_normal = s->normal;
  ends.origin_radius = s->radius;
  ends.origin_material = s->material + 1u;
  ends.origin_back = scatter->back ? 1u : 0u;
  ends.origin_through = scatter->through ? 1u : 0u;
  ends.medium = media.x + 1u; /* NO_MEDIUM: 0 */
  return ends;
}
#endif
