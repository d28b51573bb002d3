/* One sample of a pixel where the scene has specular surfaces: the eye ray goes on from mirrors, through glass and by the
 * lobe of Phong surfaces, one ray at a time, until it meets a surface that is only diffuse (ES*D), a light or nothing.
 * What the eye ray itself meets is Direct, Diffuse and Caustic as anywhere, everything behind is Specular. */
#include "render/eye_sample.cl"
#include "render/film.cl"
#include "materials/materials.cl"
#include "render/caustic.cl"

#ifdef HAS_SPECULAR

/* Two mirrors that face each other keep a ray for ever; by then, roulette has ended all but those that lose nothing. The
 * seam of two bodies of glass that overlap keeps some for hundreds of bounces. */
#define MOST_EYE_BOUNCES 1024u

/* Once a sample and bounce, in one place, without a branch: see add_radiance in kernels/render/path_sample.cl. */
static inline void add_seen(float3 direct, float3 diffuse, float3 specular, float3 caustic, bool first, float* sums) {
  const float3 none = (float3)(0.0f);
  const float3 behind = first ? specular : direct + diffuse + specular + caustic;
#ifdef HAS_CAUSTICS
  sums[SUM_CAUSTIC] += first ? caustic.x : 0.0f;
  sums[SUM_CAUSTIC + 1] += first ? caustic.y : 0.0f;
  sums[SUM_CAUSTIC + 2] += first ? caustic.z : 0.0f;
#endif
  add_direct(first ? direct : none, sums);
  add_diffuse(first ? diffuse : none, sums);
  sums[SUM_SPECULAR] += behind.x;
  sums[SUM_SPECULAR + 1] += behind.y;
  sums[SUM_SPECULAR + 2] += behind.z;
}

/* What the lobe of a surface, on which direct_irradiance was called, makes of the lights. */
static inline float3 highlight_of(const Surface* s, const __global Material* material) {
#ifdef HAS_LOBES
  if (has_flag(material, MATERIAL_HAS_LOBE))
    return s->highlight;
#endif
  return (float3)(0.0f);
}

/* Whether sampled lights reach the viewer by way of the surface. */
static inline bool is_lit(const __global Material* material) {
  return has_flag(material, MATERIAL_REFLECTS_DIFFUSELY | MATERIAL_HAS_LOBE);
}

/* Whether one cone finds what the lobe reflects of other surfaces (kernels/render/cones.cl): no ray goes on. */
static inline bool reflects_by_cone(const __global Material* material) {
#if defined(HAS_CONES) && defined(HAS_LOBES)
  return has_flag(material, MATERIAL_HAS_LOBE);
#else
  return false;
#endif
}

/* Radiance that the surface reflects of others by its lobe. Where lamps and sky are sampled they are not in the voxels; where
 * not, the lamps are, and the sky is what the cone leaves clear. */
static inline float3 reflection_by_cone(POOL_PARAMS, Lights lights, const Surface* s, float3 direction) {
#if defined(HAS_CONES) && defined(HAS_LOBES)
  const LobeCone lobe = lobe_cone(s, lights.materials + s->material, direction);
  const ConeVoxels from = {cone_voxels, cone_cells};
  const float4 seen = trace_cone(from, cone_grid, cone_apex(cone_grid, s->position, s->normal), lobe.direction,
                                 lobe.spread, CONE_LIFT, dot3(s->normal, lobe.direction));
  float3 radiance = INVERSE_PI * seen.xyz;
#ifndef HAS_LIGHT
  radiance += (1.0f - seen.w) * far_light(lights, lobe.direction, only_choice());
#endif
  return lobe.weight * radiance;
#else
  return (float3)(0.0f);
#endif
}

/* Takes what a bounce leaves of the light; false where the ray ends. */
static inline bool throughput_after(SampleId id, uint bounces, float longest, float3 factor, float3* throughput) {
  const float survival = russian_roulette(id, bounces, longest, factor);
  if (survival == 0.0f)
    return false;
  *throughput = *throughput / survival * factor;
  return is_bright(*throughput);
}

/* How the ray was chosen that goes on from s, the specular part having been taken with `probability`. */
static inline RayChoice choice_of(const Surface* s, const Scatter* scatter, float probability) {
  RayChoice choice = only_choice();
#ifdef HAS_LOBES
  choice.lobe_pdf = probability * scatter->pdf;
  choice.cosine_pdf = sky_cosine_pdf(s->normal, scatter->direction);
#endif
  return choice;
}

/* As add_surface; the back of what transmits is not black. */
static inline void add_first_surface(Lights lights, Ray ray, float t_start, const Surface* s, float* sums) {
  add_surface(lights.params, ray, t_start, s, sums);
  if (!s->front && has_flag(lights.materials + s->material, MATERIAL_TRANSMITS))
    sums[FILM_BACK_FACE] -= 1.0f;
}

/* Adds what one eye ray finds to sums[SAMPLE_SUMS]; returns the splat that it met first, or FILM_NO_POINT. `hit` is its
 * nearest hit of all, which the caller has traced and not yet counted; the camera is t_start behind the ray's origin. */
ALWAYS_INLINE
static inline uint add_sample(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float t_start, Hit hit, float* sums) {
  uint point = FILM_NO_POINT;
  float3 throughput = (float3)(1.0f);
  OcclusionEnds ends = free_ends();
  Media media = in_air();
  RayChoice choice = only_choice();
  const uint most = min(lights.params->most_bounces, MOST_EYE_BOUNCES);
#ifdef HAS_AUXILIARY
  bool follows = true;
#endif
  for (uint bounces = 0u;; ++bounces) {
    Surface s;
    Scatter scatter;
    float3 direct = (float3)(0.0f), diffuse = (float3)(0.0f), specular = (float3)(0.0f), caustic = (float3)(0.0f);
    bool goes_on = false;
    sums[FILM_RAYS] += 1.0f;
    const bool met = blended_surface(POOL_ARGS, ray, ends, hit, &s, &sums[FILM_RAYS]);
    if (met) {
      const __global Material* material = lights.materials + s.material;
      media = media_before(media, &s, lights.materials);
      throughput *= beer_of(media, lights.materials, s.t);
      if (bounces == 0u) {
        point = s.splat;
        add_first_surface(lights, ray, t_start, &s, sums);
      }
      if (s.front && is_lit(material) && (bounces == 0u || bounces < most)) {
#ifdef HAS_LIGHT
        direct = s.albedo * INVERSE_PI *
                 direct_irradiance(POOL_ARGS, &s, lights, id,
                                   viewed_by(ray.direction, reflects_by_cone(material) ? 0.0f : 1.0f), &sums[FILM_RAYS]);
        specular = highlight_of(&s, material);
#endif
        if (reflects_by_cone(material))
          specular += reflection_by_cone(POOL_ARGS, lights, &s, ray.direction);
        if (has_flag(material, MATERIAL_REFLECTS_DIFFUSELY)) {
#ifdef HAS_RADIOSITY
          diffuse = s.albedo * INVERSE_PI * irradiance_from_surfaces(POOL_ARGS, &s, id);
#endif
          caustic = s.albedo * INVERSE_PI * caustic_irradiance_of(POOL_ARGS, &s);
        }
      }
    }
    const float3 seen = seen_light(lights, met, &s, ray.direction, choice);
    direct += seen;
#ifdef HAS_AUXILIARY
    follows = add_auxiliary(follows, lights, met, &s, throughput, sums);
    add_emission(bounces == 0u ? throughput * seen : (float3)(0.0f), sums);
#endif
    add_seen(throughput * direct, throughput * diffuse, throughput * specular, throughput * caustic, bounces == 0u, sums);
    if (met && bounces < most && !reflects_by_cone(lights.materials + s.material))
      goes_on = scatter_ray(&s, lights.materials, ray.direction, stratified4(id, DIMENSION_SCATTER).xy, &media, &scatter);
    /* No longest survival: what loses nothing goes on for MOST_EYE_BOUNCES. */
    if (!goes_on || !throughput_after(id, bounces, 1.0f, scatter.weight, &throughput))
      break;
    ray = scattered_ray(&s, &scatter, lights.params->step_delta);
    ends = scattered_ends(&s, &scatter, media);
    choice = choice_of(&s, &scatter, 1.0f);
    hit = trace_closest_from(POOL_ARGS, ray, ends);
    id.vertex += 1u;
  }
  return point;
}
#endif
