/* The kernel of both integrators: the picture from the hits of its eye rays (kernels/render/eye_rays.cl). A pixel's 32 rays are
 * one work-group or half of one, shaded together (method.md section 6).
 *   PIXEL_KERNEL  its name
 *   ADD_SAMPLE    the function that finds the light of one sample: add_sample or add_path
 *   ADAPTIVE_SAMPLES  few samples may speak for all of a pixel (kernels/render/adaptive.cl); ADD_SAMPLE takes an EyeSurface
 * NDRange: (GROUP_X * ceil(columns / GROUP_PIXELS), GROUP_Y * rows), local (GROUP_X, GROUP_Y); pixel (i, j) of the tile,
 * the image's (first_x + i, first_y + j), is shaded from hits[j * columns + i] into film[(j * columns + i) *
 * FILM_STRIDE ...]. A launch takes samples first_sample to first_sample + 31 of those a pixel has, and adds to the film
 * unless first_sample is 0; of fewer the rest of the group rests. Results do not depend on how an image is cut into
 * launches. */
#include "render/film.cl"
#include "render/group.cl"

__kernel OWN_VECTORS __attribute__((reqd_work_group_size(GROUP_X, GROUP_Y, 1)))
void PIXEL_KERNEL(POOL_PARAMS, LIGHT_PARAMS,
                  const __global EyeHits* hits, __global float* film, uint first_x, uint first_y, uint columns, uint rows,
                  uint first_sample) {
  __local PixelSamples samples_of[GROUP_PIXELS];
#ifdef ADAPTIVE_SAMPLES
  __local Surface surfaces[GROUP_PIXELS][CELLS];
#endif
  const GroupItem item = group_item();
  const bool in_tile = item.column < columns && item.row < rows;
  const size_t at = item.row * (size_t)columns + item.column;
  const Lights lights = {LIGHT_ARGS};
  const SampleId id = {(uint2)(first_x + item.column, first_y + item.row), first_sample + item.lane, params->seed};
  const bool is_sample = in_tile && id.sample < params->samples;
  __local PixelSamples* pixel = samples_of + item.pixel;
  float sums[SAMPLE_SUMS];
  for (int c = 0; c < SAMPLE_SUMS; ++c)
    sums[c] = 0.0f;
#ifdef ADAPTIVE_SAMPLES
  pixel->alike[item.lane] = is_sample ? alike(POOL_ARGS, lights, hits[at].splat[item.lane], hits[at].splat[0])
                                      : ALIKE_SURFACE | ALIKE_LIGHT;
  if (!is_sample)
    keep_sample(sums, FILM_NO_POINT, item.lane, pixel);
  barrier(CLK_LOCAL_MEM_FENCE);
  const PixelPass pass = pixel_pass(id, params->samples, false);
  uint common = params->adaptive != 0u && has_cells(pass) ? ALIKE_SURFACE | ALIKE_LIGHT : 0u;
  for (uint i = 0u; i < GRID_RAYS; ++i)
    common &= pixel->alike[i];
  const uint cell = common != 0u ? cell_of(pass, item.lane) % CELLS : 0u;
  const uint speaker = common != 0u ? speaker_of(id, pass, cell) : item.lane;
  const bool speaks = speaker == item.lane;
  /* First the samples that speak, then what is left of the others: in two rounds, so that the code, which is long, stands
   * there once. */
  for (uint round = 0u; round < 2u; ++round) {
    const bool is_due = is_sample && speaks == (round == 0u);
    EyeSurface eye;
    eye.is_known = false;
    if (is_due && !speaks) {
      copy_sample(pixel, speaker, item.lane);
      eye.is_known = (common & ALIKE_LIGHT) == 0u && pixel->points[item.lane] != FILM_NO_POINT;
    }
    if (is_due && (speaks || eye.is_known)) {
      Ray ray;
      float t_start;
      sample_ray(params, id, &ray, &t_start);
      const Hit hit = {hits[at].t[item.lane], hits[at].splat[item.lane]};
      if (eye.is_known)
        eye.surface = surface_at(surfaces[item.pixel][cell], ray, hit);
      const uint point = ADD_SAMPLE(POOL_ARGS, lights, id, ray, t_start, hit, &eye, sums);
      if (!speaks) {
        keep_light(sums, item.lane, pixel);
      } else {
        keep_sample(sums, point, item.lane, pixel);
        if (common == ALIKE_SURFACE && point != FILM_NO_POINT)
          surfaces[item.pixel][cell] = eye.surface;
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
#else
  uint point = FILM_NO_POINT;
  if (is_sample) {
    Ray ray;
    float t_start;
    sample_ray(params, id, &ray, &t_start);
    const Hit hit = {hits[at].t[item.lane], hits[at].splat[item.lane]};
    point = ADD_SAMPLE(POOL_ARGS, lights, id, ray, t_start, hit, sums);
  }
  keep_sample(sums, point, item.lane, pixel);
  barrier(CLK_LOCAL_MEM_FENCE);
#endif
  if (in_tile)
    add_to_film(pixel, item.lane, first_sample, min(params->samples - first_sample, (uint)GRID_RAYS),
                film + FILM_STRIDE * at);
}
