/* The picture: a pixel's 32 rays are one work-group, traced together (method.md section 6).
 * NDRange: (GRID_X * columns, GRID_Y * rows), local (GRID_X, GRID_Y); the group at (i, j) renders the image's pixel
 * (first_x + i, first_y + j) into film[(j * columns + i) * FILM_CHANNELS ...]. A launch takes samples first_sample to
 * first_sample + 31 of those a pixel has, and adds to the film unless first_sample is 0; of fewer the rest of the group
 * rests. Results do not depend on how an image is cut into launches.
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

/* Adds what one eye ray finds to sums[FILM_SUMS]; returns the splat that it hit first, or FILM_NO_POINT. */
static inline uint add_sample(POOL_PARAMS, Lights lights, SampleId id, float2 at, float* sums) {
  Ray ray = eye_ray(lights.params, at);
  /* From the camera to the root cube at once: a far camera would cost float precision inside. */
  float t_enter, t_leave;
  Surface s;
  bool hit = ray_meets_root(ray, &t_enter, &t_leave);
  if (hit) {
    ray.origin = fma((float3)(t_enter), ray.direction, ray.origin);
    hit = trace_blended(POOL_ARGS, ray, &s, &sums[FILM_RAYS]);
  }
  if (!hit) {
    sums[FILM_DIRECT] += lights.params->environment[0];
    sums[FILM_DIRECT + 1] += lights.params->environment[1];
    sums[FILM_DIRECT + 2] += lights.params->environment[2];
    return FILM_NO_POINT;
  }
  sums[FILM_COVERAGE] += 1.0f;
  sums[FILM_ALBEDO] += s.albedo.x;
  sums[FILM_ALBEDO + 1] += s.albedo.y;
  sums[FILM_ALBEDO + 2] += s.albedo.z;
  __constant Camera* camera = &lights.params->camera;
  const float3 axis = cross(load3_constant(camera->step_y), load3_constant(camera->step_x));
  sums[FILM_DEPTH] += (t_enter + s.t) * fabs(dot3(normalize3(axis), ray.direction));
  sums[FILM_NORMAL] += s.normal.x;
  sums[FILM_NORMAL + 1] += s.normal.y;
  sums[FILM_NORMAL + 2] += s.normal.z;
  sums[FILM_POSITION] += s.position.x;
  sums[FILM_POSITION + 1] += s.position.y;
  sums[FILM_POSITION + 2] += s.position.z;
  if (!s.front) {
    sums[FILM_BACK_FACE] += 1.0f;
    return s.splat;
  }
  float3 radiance = (float3)(0.0f);
#if defined(HAS_DELTA_LIGHTS) || defined(HAS_EMITTERS) || defined(HAS_ENVIRONMENT)
  radiance = s.albedo * 0.31830989f * direct_irradiance(POOL_ARGS, &s, lights, id, &sums[FILM_RAYS]);
#endif
#ifdef HAS_EMITTERS
  radiance += load3(lights.materials[s.material].emission);
#endif
  sums[FILM_DIRECT] += radiance.x;
  sums[FILM_DIRECT + 1] += radiance.y;
  sums[FILM_DIRECT + 2] += radiance.z;
  return s.splat;
}

__kernel __attribute__((reqd_work_group_size(GRID_X, GRID_Y, 1)))
void render_pixels(POOL_PARAMS, __constant RenderParams* params, const __global Material* materials,
                   const __global DeltaLight* delta_lights, const __global Emitter* emitters, __global float* film,
                   uint first_x, uint first_y, uint first_sample) {
  __local float group_sums[FILM_SUMS][GRID_RAYS];
  __local uint group_points[GRID_RAYS];
  const uint lane = get_local_id(1) * GRID_X + get_local_id(0);
  const Lights lights = {params, materials, delta_lights, emitters};
  SampleId id;
  id.pixel = (uint2)(first_x + get_group_id(0), first_y + get_group_id(1));
  id.seed = params->seed;
  float sums[FILM_SUMS];
  for (int c = 0; c < FILM_SUMS; ++c)
    sums[c] = 0.0f;
  uint point = FILM_NO_POINT;
  id.sample = first_sample + lane;
  if (id.sample < params->samples) {
    const float2 place = place_in_pixel(id, params->samples, params->jitter != 0u);
    point = add_sample(POOL_ARGS, lights, id, convert_float2(id.pixel) + place, sums);
  }
  for (int c = 0; c < FILM_SUMS; ++c)
    group_sums[c][lane] = sums[c];
  group_points[lane] = point;
  barrier(CLK_LOCAL_MEM_FENCE);

  /* One work-item a channel adds the 32 up, in one order on every device. */
  __global float* pixel =
      film + FILM_CHANNELS * (get_group_id(1) * (size_t)get_num_groups(0) + get_group_id(0));
  if (lane < FILM_SUMS) {
    float sum = 0.0f;
    for (int i = 0; i < GRID_RAYS; ++i)
      sum += group_sums[lane][i];
    pixel[lane] = first_sample == 0u ? sum : pixel[lane] + sum;
  } else if (lane == FILM_SUMS) {
    uint first = FILM_NO_POINT;
    for (int i = GRID_RAYS - 1; i >= 0; --i)
      first = group_points[i] != FILM_NO_POINT ? group_points[i] : first;
    if (first_sample == 0u || as_uint(pixel[FILM_POINT]) == FILM_NO_POINT)
      pixel[FILM_POINT] = as_float(first);
  }
}
