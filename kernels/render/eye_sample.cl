/* One sample of a pixel: from the image to radiance.
 * L = emission + rho/pi (H_direct + H_indirect) on front sides; a back face reads 0; a miss reads the environment.
 *   NO_SHADOW_RAYS  H_direct is in the points' irradiance already */
#include "lights/lights.cl"
#include "render/camera.cl"

#define INVERSE_PI 0.31830989f

/* Uses of random numbers at a vertex, after those of kernels/lights/lights.cl (1 to 3). */
#define DIMENSION_BOUNCE 4u
#define DIMENSION_ROULETTE 5u
#define DIMENSION_SCATTER 6u

/* Bounces that no roulette ends. */
#define SURE_BOUNCES 3u

#if !defined(NO_SHADOW_RAYS) &&                                                                                         \
    (defined(HAS_DELTA_LIGHTS) || defined(HAS_EMITTERS) || defined(HAS_ENVIRONMENT))
#define HAS_LIGHT
#endif

/* What the film keeps of the surface that an eye ray meets; the camera is t_start behind the ray's origin. */
static inline void add_surface(__constant RenderParams* params, Ray ray, float t_start, const Surface* s, float* sums) {
  sums[FILM_COVERAGE] += 1.0f;
  sums[FILM_ALBEDO] += s->albedo.x;
  sums[FILM_ALBEDO + 1] += s->albedo.y;
  sums[FILM_ALBEDO + 2] += s->albedo.z;
  __constant Camera* camera = &params->camera;
  const float3 axis = cross(load3_constant(camera->step_y), load3_constant(camera->step_x));
  sums[FILM_DEPTH] += (t_start + s->t) * fabs(dot3(normalize3(axis), ray.direction));
  sums[FILM_NORMAL] += s->normal.x;
  sums[FILM_NORMAL + 1] += s->normal.y;
  sums[FILM_NORMAL + 2] += s->normal.z;
  sums[FILM_POSITION] += s->position.x;
  sums[FILM_POSITION + 1] += s->position.y;
  sums[FILM_POSITION + 2] += s->position.z;
  sums[FILM_BACK_FACE] += s->front ? 0.0f : 1.0f;
}

/* Once a sample, in one place: from several, compilers make an address of it, and the sums stand in memory. */
static inline void add_direct(float3 radiance, float* sums) {
  sums[FILM_DIRECT] += radiance.x;
  sums[FILM_DIRECT + 1] += radiance.y;
  sums[FILM_DIRECT + 2] += radiance.z;
}

static inline void add_diffuse(float3 radiance, float* sums) {
  sums[FILM_DIFFUSE] += radiance.x;
  sums[FILM_DIFFUSE + 1] += radiance.y;
  sums[FILM_DIFFUSE + 2] += radiance.z;
}

/* What the ray finds that meets nothing, or a surface that shines itself. */
static inline float3 seen_light(Lights lights, bool met, const Surface* s) {
  if (!met)
    return load3_constant(lights.params->environment);
#ifdef HAS_EMITTERS
  if (s->front)
    return load3(lights.materials[s->material].emission);
#endif
  return (float3)(0.0f);
}

/* Always inline: as a function of its own, a long path is given the sums, and the ends of rays, in memory. Compilers that are
 * told not to optimise leave marks of forced inlining that simulators do not know. */
#ifdef __OPTIMIZE__
#define IN_ITS_PLACE __attribute__((always_inline))
#else
#define IN_ITS_PLACE
#endif

#ifndef HAS_SPECULAR /* else kernels/render/specular_sample.cl */
/* Adds what one eye ray finds to sums[FILM_SUMS]; returns the splat that it met first, or FILM_NO_POINT. `hit` is its
 * nearest hit of all, which the caller has traced and not yet counted; the camera is t_start behind the ray's origin. */
static inline uint add_sample(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float t_start, Hit hit, float* sums) {
  Surface s;
  uint point = FILM_NO_POINT;
  float3 radiance = (float3)(0.0f);
#ifdef HAS_RADIOSITY
  float3 diffuse = (float3)(0.0f);
#endif
  sums[FILM_RAYS] += 1.0f;
  if (blended_surface(POOL_ARGS, ray, free_ends(), hit, &s, &sums[FILM_RAYS])) {
    point = s.splat;
    add_surface(lights.params, ray, t_start, &s, sums);
    if (s.front) {
#ifdef HAS_LIGHT
      radiance = s.albedo * INVERSE_PI * direct_irradiance(POOL_ARGS, &s, lights, id, &sums[FILM_RAYS]);
#endif
#ifdef HAS_EMITTERS
      radiance += load3(lights.materials[s.material].emission);
#endif
#ifdef HAS_RADIOSITY
      diffuse = s.albedo * INVERSE_PI * s.irradiance;
#endif
    }
  } else {
    radiance = load3_constant(lights.params->environment);
  }
  add_direct(radiance, sums);
#ifdef HAS_RADIOSITY
  add_diffuse(diffuse, sums);
#endif
  return point;
}
#endif
