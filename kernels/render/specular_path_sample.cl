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

/* Chooses, on a Phong surface at random between its diffuse part and its lobe; false where the path ends. */
static inline bool choose_bounce(const Surface* s, Lights lights, SampleId id, float3 direction, Media* media,
                                 Bounce* bounce) {
  const __global Material* material = lights.materials + s->material;
  const float3 lobe = load3(material->specular);
  const float of_lobe = fmax(fmax(lobe.x, lobe.y), lobe.z);
  const float of_both = fmax(fmax(s->albedo.x, s->albedo.y), s->albedo.z) + of_lobe;
  float chance = material->type == MATERIAL_DIFFUSE ? 0.0f : 1.0f;
  if (material->type == MATERIAL_PHONG)
    chance = of_both > 0.0f ? of_lobe / of_both : 0.0f;
  bounce->specular = random4(id, DIMENSION_ROULETTE).y < chance;
  if (bounce->specular) {
    const float2 u = stratified4(id, DIMENSION_SCATTER).xy;
    const bool goes_on = scatter_ray(s, lights.materials, direction, u, media, &bounce->scatter);
    bounce->scatter.weight /= chance;
    return goes_on;
  }
  bounce->scatter.direction = bounced_ray(s, id, 0.0f).direction;
  bounce->scatter.weight = s->albedo / (1.0f - chance);
  bounce->scatter.back = bounce->scatter.through = false;
  return s->front;
}

/* As add_sample, with all light that the eye ray finds. */
IN_ITS_PLACE
static inline uint add_path(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float t_start, Hit hit, float* sums) {
  uint point = FILM_NO_POINT;
  float3 weight = (float3)(1.0f);
  ShadowEnds ends = free_ends();
  Media media = in_air();
  uint state = 0u;                      /* of the automaton of path classes, after the surfaces so far */
  bool by_chance = true, mirrored = false; /* no shadow ray has looked for what the ray meets; the first surface is specular */
  for (uint surfaces = 1u;; ++surfaces) {
    Surface s;
    float3 found = (float3)(0.0f), highlight = (float3)(0.0f);
    sums[FILM_RAYS] += 1.0f;
    const bool met = blended_surface(POOL_ARGS, ray, ends, hit, &s, &sums[FILM_RAYS]);
    const bool within = surfaces <= lights.params->most_bounces;
    if (met) {
      media = media_before(media, &s, lights.materials);
      weight *= beer_of(media, lights.materials, s.t);
      if (surfaces == 1u) {
        point = s.splat;
        add_first_surface(lights, ray, t_start, &s, sums);
      }
    }
    if (by_chance && path_counts(lights.params, state))
      found = seen_light(lights, met, &s);
#ifdef HAS_LIGHT
    const __global Material* material = lights.materials + s.material;
    if (met && within && s.front && is_diffuse(material)) {
      const bool as_diffuse = path_counts(lights.params, path_after(lights.params, state, false));
      const bool as_specular =
          material->type == MATERIAL_PHONG && path_counts(lights.params, path_after(lights.params, state, true));
      if (as_diffuse || as_specular) {
        prepare_highlight(&s, material, ray.direction);
        const float3 direct = s.albedo * INVERSE_PI * direct_irradiance(POOL_ARGS, &s, lights, id, &sums[FILM_RAYS]);
        found += as_diffuse ? direct : (float3)(0.0f);
        highlight = as_specular ? highlight_of(&s, material) : (float3)(0.0f);
      }
    }
#endif
    const bool first = surfaces == 1u;
    const float3 none = (float3)(0.0f), both = found + highlight;
    add_seen(weight * (first ? found : none), weight * (first || mirrored ? none : both),
             weight * (first ? highlight : mirrored ? both : none), none, true, sums);
    /* Behind the last surface that counts shadow rays have looked, where it is diffuse; where not, the next ray does. */
    Bounce bounce;
    if (!met || !within || !choose_bounce(&s, lights, id, ray.direction, &media, &bounce) ||
        (!bounce.specular && surfaces >= lights.params->most_bounces))
      break;
    state = path_after(lights.params, state, bounce.specular);
    if (!path_goes_on(lights.params, state) && !(bounce.specular && path_counts(lights.params, state)))
      break;
    if (!plays_on(id, surfaces, LONGEST_SURVIVAL, bounce.scatter.weight, &weight))
      break;
    by_chance = bounce.specular;
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
