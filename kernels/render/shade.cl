/* The picture from the hits of its eye rays (kernels/render/eye_rays.cl): a pixel's 32 rays are one work-group or half of
 * one, shaded together (method.md section 6).
 * NDRange: (GROUP_X * ceil(columns / GROUP_PIXELS), GROUP_Y * rows), local (GROUP_X, GROUP_Y); pixel (i, j) of the tile,
 * the image's (first_x + i, first_y + j), is shaded from hits[j * columns + i] into film[(j * columns + i) *
 * FILM_CHANNELS ...]. A launch takes samples first_sample to first_sample + 31 of those a pixel has, and adds to the film
 * unless first_sample is 0; of fewer the rest of the group rests. Results do not depend on how an image is cut into
 * launches. */
#include "render/eye_sample.cl"
#include "render/group.cl"

__kernel __attribute__((reqd_work_group_size(GROUP_X, GROUP_Y, 1)))
void shade_pixels(POOL_PARAMS, __constant RenderParams* params, const __global Material* materials,
                  const __global DeltaLight* delta_lights, const __global Emitter* emitters,
                  const __global EyeHits* hits, __global float* film, uint first_x, uint first_y, uint columns, uint rows,
                  uint first_sample) {
  __local float sums_of[GROUP_PIXELS][FILM_SUMS][GRID_RAYS];
  __local uint points_of[GROUP_PIXELS][GRID_RAYS];
  const GroupItem item = group_item();
  const uint lane = item.lane;
  __local float(*group_sums)[GRID_RAYS] = sums_of[item.pixel];
  __local uint* group_points = points_of[item.pixel];
  const bool in_tile = item.column < columns && item.row < rows;
  const size_t at = item.row * (size_t)columns + item.column;
  const Lights lights = {params, materials, delta_lights, emitters};
  const SampleId id = {(uint2)(first_x + item.column, first_y + item.row), first_sample + lane, params->seed};
  float sums[FILM_SUMS];
  for (int c = 0; c < FILM_SUMS; ++c)
    sums[c] = 0.0f;
  uint point = FILM_NO_POINT;
  if (in_tile && id.sample < params->samples) {
    Ray ray;
    float t_start;
    sample_ray(params, id, &ray, &t_start);
    const Hit hit = {hits[at].t[lane], hits[at].splat[lane]};
    point = add_sample(POOL_ARGS, lights, id, ray, t_start, hit, sums);
  }
  for (int c = 0; c < FILM_SUMS; ++c)
    group_sums[c][lane] = sums[c];
  group_points[lane] = point;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (!in_tile)
    return;

  /* One work-item a channel adds the 32 up, in one order on every device. */
  __global float* pixel = film + FILM_CHANNELS * at;
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
