/* From a place in the image to an eye ray. */
#include "lib/ray.cl"
#include "lib/sampling.cl"

/* Farther off than this, in root cubes, rays start where they enter the cube: on the way there they would lose the
 * precision that the cube's floats have. */
#define NEAR_CAMERA 4.0f

static inline bool camera_is_near(__constant RenderParams* params) {
  const float3 away = load3_constant(params->camera.origin) - 0.5f;
  return dot3(away, away) < NEAR_CAMERA * NEAR_CAMERA;
}

static inline float3 eye_direction(__constant RenderParams* params, float2 at) {
  __constant Camera* camera = &params->camera;
  return normalize3(load3_constant(camera->corner) + at.x * load3_constant(camera->step_x) +
                    at.y * load3_constant(camera->step_y));
}

/* The ray through an image position; it starts *t_start in front of the camera. False when it cannot meet a splat. */
static inline bool eye_ray(__constant RenderParams* params, float2 at, Ray* ray, float* t_start) {
  ray->origin = load3_constant(params->camera.origin);
  ray->direction = eye_direction(params, at);
  ray->t_min = 0.0f;
  ray->t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  ray->step_delta = params->step_delta;
#endif
  *t_start = 0.0f;
  if (camera_is_near(params))
    return true;
  float t_leave;
  if (!ray_meets_root(*ray, t_start, &t_leave))
    return false;
  ray->origin = fma((float3)(*t_start), ray->direction, ray->origin);
  return true;
}

/* The ray of one sample. */
static inline bool sample_ray(__constant RenderParams* params, SampleId id, Ray* ray, float* t_start) {
  const float2 place = place_in_pixel(id, params->samples, params->jitter != 0u);
  return eye_ray(params, convert_float2(id.pixel) + place, ray, t_start);
}
