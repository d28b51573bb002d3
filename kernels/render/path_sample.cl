/* One sample of a pixel by path tracing, the measure of every other way of computing light: unbiased over the same
 * splats, blending, materials and lights. At every diffuse surface light straight from its sources is gathered by shadow
 * rays (kernels/lights/lights.cl), and the path goes on in a direction drawn by the cosine: rho/pi cos / (cos/pi) =
 * rho. Emission and environment count where a camera's ray meets them; where a bounced ray does, the shadow rays of the
 * surface before have counted them. No sample is clamped: what is noisy shows in the variance.
 *   PATH_CLASSES  defined only where params->path_states leaves some paths out */
#define BOUNCED_RAYS
#include "render/eye_sample.cl"

/* A path survives with the probability of its surface's largest albedo, so the strongest colour keeps its weight. Less
 * than 1, or a path between white walls would never end. */
#define LONGEST_SURVIVAL 0.995f

#ifdef PATH_CLASSES
/* Whether a path counts that ends in light after the surfaces that led to `state`; whether some longer one does. */
static inline bool path_counts(__constant RenderParams* params, uint state) {
  return (params->path_states[state] & PATH_COUNTS) != 0u;
}
static inline bool path_goes_on(__constant RenderParams* params, uint state) {
  return (params->path_states[state] & PATH_GOES_ON) != 0u;
}
/* The state after one more surface. */
static inline uint path_after(__constant RenderParams* params, uint state, bool specular) {
  const uint entry = params->path_states[state];
  return specular ? PATH_AFTER_S(entry) : PATH_AFTER_D(entry);
}
#else
#define path_counts(params, state) true
#define path_goes_on(params, state) true
#define path_after(params, state, specular) 0u
#endif

/* The ray that a path goes on with. It starts where shadow rays do (in_light). */
static inline Ray bounced_ray(const Surface* s, SampleId id, float step_delta) {
  const float4 u = stratified4(id, DIMENSION_BOUNCE);
  Ray ray;
  ray.origin = s->position;
  ray.direction = cosine_direction(s->normal, u.x, u.y);
  ray.t_min = BEHIND_SURFACE(s->radius);
  ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  return ray;
}

/* Reflects the path's throughput off the surface that is its `surfaces`-th; false where the path ends. */
static inline bool reflect_path(const Surface* s, SampleId id, uint surfaces, float3* throughput) {
  const float survival = russian_roulette(id, surfaces, LONGEST_SURVIVAL, s->albedo);
  if (survival == 0.0f)
    return false;
  *throughput = *throughput * s->albedo / survival;
  return is_bright(*throughput);
}

/* Without a branch, as an address that is chosen would put the sums into memory. */
static inline void add_radiance(float3 radiance, bool direct, float* sums) {
  const float3 none = (float3)(0.0f);
  add_direct(direct ? radiance : none, sums);
  add_diffuse(direct ? none : radiance, sums);
}

#ifndef HAS_SPECULAR /* else kernels/render/specular_path_sample.cl */
/* As add_sample, with all light that the eye ray finds. */
ALWAYS_INLINE
static inline uint add_path(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float t_start, Hit hit, float* sums) {
  uint point = FILM_NO_POINT;
  float3 throughput = (float3)(1.0f);
  OcclusionEnds ends = free_ends();
  uint state = 0u; /* of the automaton of path classes, after the surfaces so far */
  for (uint surfaces = 1u;; ++surfaces) {
    Surface s;
    float3 radiance = (float3)(0.0f);
    sums[FILM_RAYS] += 1.0f;
    const bool met = blended_surface(POOL_ARGS, ray, ends, hit, &s, &sums[FILM_RAYS]);
    if (surfaces == 1u) {
      if (met) {
        point = s.splat;
        add_surface(lights.params, ray, t_start, &s, sums);
      }
      if (path_counts(lights.params, state))
        radiance = seen_light(lights, met, &s, ray.direction, only_choice());
#ifdef HAS_AUXILIARY
      add_auxiliary(true, lights, met, &s, throughput, sums);
      add_emission(radiance, sums);
#endif
    }
    state = path_after(lights.params, state, false);
    const bool shines = met && s.front && surfaces <= lights.params->most_bounces;
#ifdef HAS_LIGHT
    if (shines && path_counts(lights.params, state))
      radiance += throughput * (s.albedo * INVERSE_PI *
                               direct_irradiance(POOL_ARGS, &s, lights, id, viewed_by(ray.direction, 0.0f), &sums[FILM_RAYS]));
#endif
    add_radiance(radiance, surfaces == 1u, sums);
    if (!shines || surfaces == lights.params->most_bounces || !reflect_path(&s, id, surfaces, &throughput))
      break;
    ray = bounced_ray(&s, id, lights.params->step_delta);
    ends.origin_normal = s.normal;
    ends.origin_radius = s.radius;
    hit = trace_closest_from(POOL_ARGS, ray, ends);
    id.vertex += 1u;
  }
  return point;
}
#endif
