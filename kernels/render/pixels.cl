/* The kernel of both integrators: the picture from the hits of its eye rays (kernels/render/eye_rays.cl). A pixel's 32 rays are
 * one work-group or half of one, shaded together (method.md section 6).
 *   PIXEL_KERNEL  its name
 *   ADD_SAMPLE    the function that finds the light of one sample: add_sample or add_path
 *   ADAPTIVE_SAMPLES  few samples may speak for all of a pixel (kernels/render/adaptive.cl)
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
  const GroupItem item = group_item();
  const bool in_tile = item.column < columns && item.row < rows;
  const size_t at = item.row * (size_t)columns + item.column;
  const Lights lights = {LIGHT_ARGS};
  const SampleId id = {(uint2)(first_x + item.column, first_y + item.row), first_sample + item.lane, params->seed};
  float sums[SAMPLE_SUMS];
  for (int c = 0; c < SAMPLE_SUMS; ++c)
    sums[c] = 0.0f;
  uint point = FILM_NO_POINT;
  bool is_shaded = in_tile && id.sample < params->samples;
#ifdef ADAPTIVE_SAMPLES
  uint speaker = item.lane;
  samples_of[item.pixel].alike[item.lane] =
      !is_shaded || is_alike(POOL_ARGS, lights, hits[at].splat[item.lane], hits[at].splat[0]) ? 1u : 0u;
  barrier(CLK_LOCAL_MEM_FENCE);
  uint alike = params->adaptive;
  for (uint i = 0u; i < GRID_RAYS; ++i)
    alike &= samples_of[item.pixel].alike[i];
  if (alike != 0u && is_shaded)
    speaker = speaker_of(id, params->samples, item.lane);
  is_shaded = is_shaded && speaker == item.lane;
#endif
  if (is_shaded) {
    Ray ray;
    float t_start;
    sample_ray(params, id, &ray, &t_start);
    const Hit hit = {hits[at].t[item.lane], hits[at].splat[item.lane]};
    point = ADD_SAMPLE(POOL_ARGS, lights, id, ray, t_start, hit, sums);
  }
  keep_sample(sums, point, item.lane, samples_of + item.pixel);
  barrier(CLK_LOCAL_MEM_FENCE);
#ifdef ADAPTIVE_SAMPLES
  if (speaker != item.lane)
    copy_sample(samples_of + item.pixel, speaker, item.lane);
  barrier(CLK_LOCAL_MEM_FENCE);
#endif
  if (in_tile)
    add_to_film(samples_of + item.pixel, item.lane, first_sample, min(params->samples - first_sample, (uint)GRID_RAYS),
                film + FILM_STRIDE * at);
}
