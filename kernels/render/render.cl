/* The picture: a pixel's 32 rays are one work-group or half of one, traced together (method.md section 6).
 *   GROUP_X, GROUP_Y  shape of a work-group, 32 or 64 work-items; which pixel and sample is whose goes by their linear
 *                     number, so that no bit of the picture depends on the shape
 * NDRange: (GROUP_X * ceil(columns / GROUP_PIXELS), GROUP_Y * rows), local (GROUP_X, GROUP_Y); the group at (i, j) renders
 * the image's pixels (first_x + GROUP_PIXELS * i ..., first_y + j), those before `columns`, into film[(j * columns + i) *
 * FILM_CHANNELS ...]. A launch takes samples first_sample to first_sample + 31 of those a pixel has, and adds to the film
 * unless first_sample is 0; of fewer the rest of the group rests. Results do not depend on how an image is cut into
 * launches.
 * The form of the picture kernel for devices that run a group in lockstep; kernels/render/render_packets.cl is the other. */
#ifndef GROUP_X
#define GROUP_X 8
#endif
#ifndef GROUP_Y
#define GROUP_Y 4
#endif
#include "render/eye_sample.cl"

#define GROUP_PIXELS (GROUP_X * GROUP_Y / GRID_RAYS)

__kernel __attribute__((reqd_work_group_size(GROUP_X, GROUP_Y, 1)))
void render_pixels(POOL_PARAMS, __constant RenderParams* params, const __global Material* materials,
                   const __global DeltaLight* delta_lights, const __global Emitter* emitters, __global float* film,
                   uint first_x, uint first_y, uint columns, uint rows, uint first_sample) {
  __local float sums_of[GROUP_PIXELS][FILM_SUMS][GRID_RAYS];
  __local uint points_of[GROUP_PIXELS][GRID_RAYS];
  const uint number = get_local_id(1) * GROUP_X + get_local_id(0), lane = number % GRID_RAYS, mine = number / GRID_RAYS;
  const uint column = GROUP_PIXELS * get_group_id(0) + mine, row = get_group_id(1);
  __local float(*group_sums)[GRID_RAYS] = sums_of[mine];
  __local uint* group_points = points_of[mine];
  const Lights lights = {params, materials, delta_lights, emitters};
  SampleId id;
  id.pixel = (uint2)(first_x + column, first_y + row);
  id.seed = params->seed;
  float sums[FILM_SUMS];
  for (int c = 0; c < FILM_SUMS; ++c)
    sums[c] = 0.0f;
  uint point = FILM_NO_POINT;
  id.sample = first_sample + lane;
  if (column < columns && row < rows && id.sample < params->samples) {
    const float2 place = place_in_pixel(id, params->samples, params->jitter != 0u);
    point = add_traced_sample(POOL_ARGS, lights, id, eye_ray(params, convert_float2(id.pixel) + place), sums);
  }
  for (int c = 0; c < FILM_SUMS; ++c)
    group_sums[c][lane] = sums[c];
  group_points[lane] = point;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (column >= columns || row >= rows)
    return;

  /* One work-item a channel adds the 32 up, in one order on every device. */
  __global float* pixel = film + FILM_CHANNELS * (row * (size_t)columns + column);
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
