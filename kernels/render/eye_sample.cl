/* One sample of a pixel: from the image to radiance.
 * L = emission + rho/pi * H_direct on front sides; a back face reads 0; a miss reads the environment. */
#include "lib/direct_light.cl"

static inline Ray eye_ray(__constant RenderParams* params, float2 at) {
  __constant Camera* camera = &params->camera;
  const float3 d = load3_constant(camera->corner) + at.x * load3_constant(camera->step_x) +
                   at.y * load3_constant(camera->step_y);
  Ray ray;
  ray.origin = load3_constant(camera->origin);
  ray.direction = normalize3(d);
  ray.t_min = 0.0f;
  ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  ray.step_delta = params->step_delta;
#endif
  return ray;
}

/* Adds what one eye ray finds to sums[FILM_SUMS]; returns the splat that it met first, or FILM_NO_POINT. `hit` is its
 * nearest hit of all, which the caller has traced and not yet counted; the camera is t_start behind the ray's origin. */
static inline uint add_sample(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float t_start, Hit hit, float* sums) {
  Surface s;
  uint point = FILM_NO_POINT;
  float3 radiance = (float3)(0.0f);
  sums[FILM_RAYS] += 1.0f;
  if (blended_surface(POOL_ARGS, ray, hit, &s, &sums[FILM_RAYS])) {
    point = s.splat;
    sums[FILM_COVERAGE] += 1.0f;
    sums[FILM_ALBEDO] += s.albedo.x;
    sums[FILM_ALBEDO + 1] += s.albedo.y;
    sums[FILM_ALBEDO + 2] += s.albedo.z;
    __constant Camera* camera = &lights.params->camera;
    const float3 axis = cross(load3_constant(camera->step_y), load3_constant(camera->step_x));
    sums[FILM_DEPTH] += (t_start + s.t) * fabs(dot3(normalize3(axis), ray.direction));
    sums[FILM_NORMAL] += s.normal.x;
    sums[FILM_NORMAL + 1] += s.normal.y;
    sums[FILM_NORMAL + 2] += s.normal.z;
    sums[FILM_POSITION] += s.position.x;
    sums[FILM_POSITION + 1] += s.position.y;
    sums[FILM_POSITION + 2] += s.position.z;
    sums[FILM_BACK_FACE] += s.front ? 0.0f : 1.0f;
    if (s.front) {
#if defined(HAS_DELTA_LIGHTS) || defined(HAS_EMITTERS) || defined(HAS_ENVIRONMENT)
      radiance = s.albedo * 0.31830989f * direct_irradiance(POOL_ARGS, &s, lights, id, &sums[FILM_RAYS]);
#endif
#ifdef HAS_EMITTERS
      radiance += load3(lights.materials[s.material].emission);
#endif
    }
  } else {
    radiance = load3_constant(lights.params->environment);
  }
  /* Added in one place: from several, compilers make an address of it, and the sums stand in memory. */
  sums[FILM_DIRECT] += radiance.x;
  sums[FILM_DIRECT + 1] += radiance.y;
  sums[FILM_DIRECT + 2] += radiance.z;
  return point;
}

/* The same for an eye ray that is traced on its own. */
static inline uint add_traced_sample(POOL_PARAMS, Lights lights, SampleId id, Ray ray, float* sums) {
  /* From the camera to the root cube at once: a far camera would cost float precision inside. */
  float t_enter, t_leave;
  Hit hit = {ray.t_max, NO_SPLAT};
  if (ray_meets_root(ray, &t_enter, &t_leave)) {
    ray.origin = fma((float3)(t_enter), ray.direction, ray.origin);
    hit = trace_closest(POOL_ARGS, ray);
  }
  return add_sample(POOL_ARGS, lights, id, ray, t_enter, hit, sums);
}
