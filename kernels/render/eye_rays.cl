/* Nearest hits of the eye rays of a tile. A launch takes samples first_sample to first_sample + 31 of those a pixel has,
 * fewer at the end; hits[j * columns + i] are those of the image's pixel (first_x + i, first_y + j).
 *   GROUP_X, GROUP_Y  shape of a work-group, 32 or 64 work-items: one or two pixels, a ray a work-item, by their linear
 *                     number; NDRange (GROUP_X * ceil(columns / GROUP_PIXELS), GROUP_Y * rows)
 *   RAY_PACKETS       instead a work-item traces the rays of 2 x 2 pixels as one packet (kernels/traverse/wide_packet.cl);
 *                     NDRange (columns, rows) in such squares, padded
 *   FRONTS_ONLY       they pass through the backs of surfaces (kernels/surface/disc.cl) */
#include "render/camera.cl"
#include "render/group.cl"
#include "traverse/traversal.cl"

/* One sample's ray, traced on its own. */
static inline Hit eye_hit(POOL_PARAMS, __constant RenderParams* params, SampleId id) {
  Ray ray;
  float t_start;
  const Hit none = {INFINITY, NO_SPLAT};
  return sample_ray(params, id, &ray, &t_start) ? trace_closest(POOL_ARGS, ray) : none;
}

#ifdef RAY_PACKETS
#include "traverse/wide_packet.cl"

#define LANES_16 ((uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))

/* eye_direction of 16 samples of a pixel from `sample` on, with bit-identical results; past the last one, of the last. */
static inline void add_rays(__constant RenderParams* params, uint2 pixel, uint sample, uint last, int group, RayPacket* p) {
  __constant Camera* camera = &params->camera;
  const uint16 id = min(sample + LANES_16, (uint16)(last));
  float16 u = (float16)(0.5f), v = (float16)(0.5f);
  if (params->jitter != 0u) { /* random4(id, 0) */
    uint16 a = (uint16)(pixel.x), b = (uint16)(pixel.y), c = id, d = (uint16)(params->seed * 0x9E3779B9u);
    PCG4D(a, b, c, d);
    u = convert_float16(a >> 8u) * 0x1p-24f;
    v = convert_float16(b >> 8u) * 0x1p-24f;
  }
  const SampleId first = {pixel, sample, params->seed};
  const PixelPass pass = pixel_pass(first, params->samples, params->jitter != 0u);
  const uint16 i = id % GRID_RAYS;
  uint16 column, row;
  STRATA_OF_SAMPLE(pass, uint16, i, column, row);
  const float16 at_x = (float)pixel.x + (convert_float16(column) + u) / (float)pass.strata.x;
  const float16 at_y = (float)pixel.y + (convert_float16(row) + v) / (float)pass.strata.y;
  const float16 x = camera->corner[0] + at_x * camera->step_x[0] + at_y * camera->step_y[0];
  const float16 y = camera->corner[1] + at_x * camera->step_x[1] + at_y * camera->step_y[1];
  const float16 z = camera->corner[2] + at_x * camera->step_x[2] + at_y * camera->step_y[2];
  const float16 length = sqrt(fma(x, x, fma(y, y, z * z)));
  p->x[group] = x / length;
  p->y[group] = y / length;
  p->z[group] = z / length;
}

/* Pixel k of the square at (x, y) of a tile; inside the tile also where the square sticks out. */
static inline uint2 pixel_of_square(uint2 square, uint k, uint columns, uint rows) {
  return (uint2)(min(PACKET_COLUMNS * square.x + k % PACKET_COLUMNS, columns - 1u),
                 min(PACKET_ROWS * square.y + k / PACKET_COLUMNS, rows - 1u));
}

__kernel OWN_VECTORS void trace_eye_rays(POOL_PARAMS, __constant RenderParams* params, __global EyeHits* hits, uint first_x,
                             uint first_y, uint columns, uint rows, uint first_sample) {
  const uint2 square = (uint2)(get_global_id(0), get_global_id(1));
  if (PACKET_COLUMNS * square.x >= columns || PACKET_ROWS * square.y >= rows)
    return;
  const uint last = min(params->samples, first_sample + GRID_RAYS) - 1u;
  if (!camera_is_near(params)) { /* rays that start in many places */
    for (uint k = 0u; k < PACKET_COLUMNS * PACKET_ROWS; ++k) {
      const uint2 at = pixel_of_square(square, k, columns, rows);
      for (uint s = 0u; s <= last - first_sample; ++s) {
        const SampleId id = {(uint2)(first_x, first_y) + at, first_sample + s, params->seed};
        const Hit hit = eye_hit(POOL_ARGS, params, id);
        hits[at.y * columns + at.x].t[s] = hit.t;
        hits[at.y * columns + at.x].splat[s] = hit.splat;
      }
    }
    return;
  }
  RayPacket packet;
  for (uint k = 0u; k < PACKET_COLUMNS * PACKET_ROWS; ++k) {
    const uint2 pixel = (uint2)(first_x, first_y) + pixel_of_square(square, k, columns, rows);
    add_rays(params, pixel, first_sample, last, 2 * k, &packet);
    add_rays(params, pixel, first_sample + 16u, last, 2 * k + 1, &packet);
  }
  packet.origin = load3_constant(params->camera.origin);
  packet.t_min = 0.0f;
  packet.t_max = INFINITY;
  PacketHits found;
  trace_packet(POOL_ARGS, &packet, &found);
  for (uint k = 0u; k < PACKET_COLUMNS * PACKET_ROWS; ++k) {
    const uint2 at = pixel_of_square(square, k, columns, rows);
    __global EyeHits* of = hits + at.y * columns + at.x;
    for (uint half_pixel = 0u; half_pixel < 2u; ++half_pixel) {
      vstore16(found.t[2u * k + half_pixel], half_pixel, of->t);
      vstore16(found.splat[2u * k + half_pixel], half_pixel, of->splat);
    }
  }
}
#else

__kernel OWN_VECTORS __attribute__((reqd_work_group_size(GROUP_X, GROUP_Y, 1)))
void trace_eye_rays(POOL_PARAMS, __constant RenderParams* params, __global EyeHits* hits, uint first_x, uint first_y,
                    uint columns, uint rows, uint first_sample) {
  const GroupItem item = group_item();
  const SampleId id = {(uint2)(first_x + item.column, first_y + item.row), first_sample + item.lane, params->seed};
  if (item.column >= columns || item.row >= rows || id.sample >= params->samples)
    return;
  const Hit hit = eye_hit(POOL_ARGS, params, id);
  __global EyeHits* of = hits + item.row * (size_t)columns + item.column;
  of->t[item.lane] = hit.t;
  of->splat[item.lane] = hit.splat;
}
#endif
