/* Path tracing where the scene has specular surfaces: as kernels/render/path_sample.cl, and after a specular bounce, for
 * which no shadow ray can look, emission and environment count where the ray meets them. Light that reaches a diffuse
 * surface by way of mirrors and glass is found by chance alone: slow from small lights, never from points and directions.
 * Paths whose first surface is a specular one are the channel Specular. */
#include "render/path_sample.cl"
#include "render/specular_sample.cl"

#ifdef HAS_SPECULAR

/* How a path goes on from a surface. */
typedef struct Bounce {
  Scatter scatter;
  bool specular;
} Bounce;

/* Chooses at random between a surface's diffuse and specular parts, the latter with `probability`; false where the path ends. */
static inline bool choose_bounce(const Surface* s, Lights lights, SampleId id, float3 direction, float probability,
                                 Media* media, Bounce* bounce) {
  bounce->specular = random4(id, DIMENSION_ROULETTE).y < probability;
  if (bounce->specular) {
    const float2 u = stratified4(id, DIMENSION_SCATTER).xy;
    const bool goes_on = scatter_ray(s, lights.materials, direction, u, media, &bounce->scatter);
    bounce->scatter.weight /= probability;
    return goes_on;
  }
  bounce->scatter.direction = bounced_ray(s, id, 0.0f).direction;
  bounce->scatter.weight = s->albedo / (1.0f - probability);
  bounce->scatter.pdf = 0.0f;
  bounce->scatter.back = bounce->scatter.through = false;
  return s->front;
}

/* As add_sample, with all light that the eye ray finds. */
ALWAYS_INLINE
static inline uint add_path(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float t_start, Hit hit, float* sums) {
  uint point = FILM_NO_POINT;
  float3 throughput = (float3)(1.0f);
  OcclusionEnds ends = free_ends();
  Media media = in_air();
  uint state = 0u;                      /* of the automaton of path classes, after the surfaces so far */
  bool by_chance = true, mirrored = false; /* no sampled light stands for all that the ray meets; the first surface is specular */
  RayChoice choice = only_choice();
#ifdef HAS_AUXILIARY
  bool follows = true;
#endif
  for (uint surfaces = 1u;; ++surfaces) {
    Surface s;
    float3 found = (float3)(0.0f), highlight = (float3)(0.0f);
    sums[FILM_RAYS] += 1.0f;
    const bool met = blended_surface(POOL_ARGS, ray, ends, hit, &s, &sums[FILM_RAYS]);
    const bool within = surfaces <= lights.params->most_bounces;
    if (met) {
      media = media_before(media, &s, lights.materials);
      throughput *= beer_of(media, lights.materials, s.t);
      if (surfaces == 1u) {
        point = s.splat;
        add_first_surface(lights, ray, t_start, &s, sums);
      }
    }
    if (by_chance && path_counts(lights.params, state))
      found = seen_light(lights, met, &s, ray.direction, choice);
#ifdef HAS_AUXILIARY
    follows = add_auxiliary(follows, lights, met, &s, throughput, sums);
    add_emission(surfaces == 1u ? throughput * found : (float3)(0.0f), sums);
#endif
    const __global Material* material = lights.materials + (met ? s.material : 0u);
    const float probability = met ? specular_probability(&s, material) : 0.0f;
#ifdef HAS_LIGHT
    if (met && within && s.front && is_lit(material)) {
      const bool as_diffuse = path_counts(lights.params, path_after(lights.params, state, false));
      const bool as_specular =
          has_flag(material, MATERIAL_HAS_LOBE) && path_counts(lights.params, path_after(lights.params, state, true));
      if (as_diffuse || as_specular) {
        const float3 direct = s.albedo * INVERSE_PI *
                              direct_irradiance(POOL_ARGS, &s, lights, id, viewed_by(ray.direction, probability), &sums[FILM_RAYS]);
        found += as_diffuse ? direct : (float3)(0.0f);
        highlight = as_specular ? highlight_of(&s, material) : (float3)(0.0f);
      }
    }
#endif
    const bool first = surfaces == 1u;
    const float3 none = (float3)(0.0f), both = found + highlight;
    add_seen(throughput * (first ? found : none), throughput * (first || mirrored ? none : both),
             throughput * (first ? highlight : mirrored ? both : none), none, true, sums);
    /* Behind the last surface that counts shadow rays have looked, where it is diffuse; where not, the next ray does. */
    Bounce bounce;
    if (!met || !within || !choose_bounce(&s, lights, id, ray.direction, probability, &media, &bounce) ||
        (!bounce.specular && surfaces >= lights.params->most_bounces))
      break;
    state = path_after(lights.params, state, bounce.specular);
    if (!path_goes_on(lights.params, state) && !(bounce.specular && path_counts(lights.params, state)))
      break;
    if (!throughput_after(id, surfaces, LONGEST_SURVIVAL, bounce.scatter.weight, &throughput))
      break;
    by_chance = bounce.specular;
    choice = choice_of(&s, &bounce.scatter, probability);
    mirrored = first ? bounce.specular : mirrored;
    ray = scattered_ray(&s, &bounce.scatter, lights.params->step_delta);
    ends = scattered_ends(&s, &bounce.scatter, media);
    if (!bounce.specular)
      ends.origin_material = 0u;
    hit = trace_closest_from(POOL_ARGS, ray, ends);
    id.vertex += 1u;
  }
  return point;
}
#endif
