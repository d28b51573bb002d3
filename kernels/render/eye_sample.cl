/* One sample of a pixel: from the image to radiance.
 * L = emission + rho/pi (H_direct + H_indirect) on front sides; a back face reads 0; a miss reads the environment.
 *   NO_SHADOW_RAYS  H_direct is in the points' irradiance already */
#include "lights/lights.cl"
#include "render/auxiliary.cl"
#include "render/camera.cl"
#include "render/cones.cl"

/* Uses of random numbers at a vertex, after those of kernels/lights/lights.cl (1 to 3, 7). */
#define DIMENSION_BOUNCE 4u
#define DIMENSION_ROULETTE 5u
#define DIMENSION_SCATTER 6u

/* Bounces that no roulette ends. */
#define SURE_BOUNCES 3u

#if !defined(NO_SHADOW_RAYS) &&                                                                                         \
    (defined(HAS_LIGHT_SOURCES) || defined(HAS_EMITTERS) || defined(HAS_ENVIRONMENT))
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

/* How the ray was chosen that now meets something: densities per solid angle. */
typedef struct RayChoice {
#ifdef HAS_LOBES
  float lobe_pdf;   /* of the lobe that has sent the ray out; 0: no sampled light could have found what it meets */
  float cosine_pdf; /* by the cosine at the surface there, in the ray's direction; 0: no sampled light was from there */
#endif
  float unused;
} RayChoice;

static inline RayChoice only_choice(void) {
  RayChoice choice;
#ifdef HAS_LOBES
  choice.lobe_pdf = choice.cosine_pdf = 0.0f;
#endif
  choice.unused = 0.0f;
  return choice;
}

/* Share of the light that the ray meets which counts, as sampled lights count the rest. `light_pdf`: with which they are. */
static inline float share_of_ray(RayChoice choice, float light_pdf) {
#if defined(HAS_LOBES) && defined(HAS_LIGHT)
  if (choice.lobe_pdf > 0.0f)
    return mis_weight(choice.lobe_pdf, light_pdf);
#endif
  return 1.0f;
}

/* What the ray finds that meets nothing. */
static inline float3 far_light(Lights lights, float3 direction, RayChoice choice) {
#ifdef HAS_LOBES
  const SkyLight sky = sky_light(lights, direction, choice.cosine_pdf);
  float3 radiance = sky.radiance * share_of_ray(choice, sky.pdf);
#else
  float3 radiance = sky_light(lights, direction, 0.0f).radiance;
#endif
#ifdef HAS_LIGHT_DISCS
  for (uint i = 0u; i < lights.params->light_sources; ++i) {
    float pdf;
    const float3 of_light = light_towards(lights, i, direction, &pdf);
#ifdef HAS_LOBES
    pdf = choice.cosine_pdf > 0.0f ? pdf : 0.0f;
#endif
    radiance += of_light * share_of_ray(choice, pdf);
  }
#endif
  return radiance;
}

/* What the ray finds that meets nothing, or a surface that shines itself. */
static inline float3 seen_light(Lights lights, bool met, const Surface* s, float3 direction, RayChoice choice) {
  if (!met)
    return far_light(lights, direction, choice);
#ifdef HAS_EMITTERS
  if (s->front) {
    float pdf = emitter_pdf(s, lights.materials, direction);
#ifdef HAS_LOBES
    pdf = choice.cosine_pdf > 0.0f ? pdf : 0.0f; /* below the smooth normal no light is sampled */
#endif
    return load3(lights.materials[s->material].emission) * share_of_ray(choice, pdf);
  }
#endif
  return (float3)(0.0f);
}

/* Russian roulette: probability with which a ray goes on after `bounces` bounces, `factor`, what the surface leaves of its
 * light, in its strongest colour, `longest` at most; 1 while bounces are sure; 0 where chance ends the ray. */
static inline float russian_roulette(SampleId id, uint bounces, float longest, float3 factor) {
  if (bounces <= SURE_BOUNCES)
    return 1.0f;
  const float survival = fmin(fmax(fmax(factor.x, factor.y), factor.z), longest);
  return random4(id, DIMENSION_ROULETTE).x < survival ? survival : 0.0f;
}

static inline bool is_bright(float3 v) { return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f; }

/* Always inline: as a function of its own, a long path is given the sums, and the ends of rays, in memory. Compilers that are
 * told not to optimise leave marks of forced inlining that simulators do not know. */
#ifdef __OPTIMIZE__
#define ALWAYS_INLINE __attribute__((always_inline))
#else
#define ALWAYS_INLINE
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
  const bool met = blended_surface(POOL_ARGS, ray, free_ends(), hit, &s, &sums[FILM_RAYS]);
#ifdef HAS_AUXILIARY
  add_auxiliary(true, lights, met, &s, (float3)(1.0f), sums);
  add_emission(seen_light(lights, met, &s, ray.direction, only_choice()), sums);
#endif
  if (met) {
    point = s.splat;
    add_surface(lights.params, ray, t_start, &s, sums);
    if (s.front) {
#ifdef HAS_LIGHT
      radiance = s.albedo * INVERSE_PI * direct_irradiance(POOL_ARGS, &s, lights, id, viewed_by(ray.direction, 0.0f), &sums[FILM_RAYS]);
#endif
#ifdef HAS_EMITTERS
      radiance += load3(lights.materials[s.material].emission);
#endif
#ifdef HAS_RADIOSITY
      diffuse = s.albedo * INVERSE_PI * irradiance_from_surfaces(POOL_ARGS, &s, id);
#endif
    }
  } else {
    radiance = far_light(lights, ray.direction, only_choice());
  }
  add_direct(radiance, sums);
#ifdef HAS_RADIOSITY
  add_diffuse(diffuse, sums);
#endif
  return point;
}
#endif
