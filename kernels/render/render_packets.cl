/* The picture, a pixel a work-item: its 32 eye rays are traced together as one packet (kernels/lib/wide_packet.cl), then
 * shaded one by one. For devices whose work-items have vector registers of their own; the sums are those of
 * kernels/render/render.cl, added in the same order.
 * NDRange: (columns, rows), padded to whole groups of any shape; the work-item at (i, j) renders the image's pixel
 * (first_x + i, first_y + j) into film[(j * columns + i) * FILM_CHANNELS ...]. A launch takes samples first_sample to first_sample + 31 of those a pixel
 * has, and adds to the film unless first_sample is 0. */
#include "lib/traversal.cl"
#include "lib/wide_packet.cl"
#include "render/eye_sample.cl"

/* Farther off than this, in root cubes, rays are moved to the cube one by one before they are traced, for precision. */
#define NEAR_CAMERA 4.0f

__kernel void render_pixels(POOL_PARAMS, __constant RenderParams* params, const __global Material* materials,
                            const __global DeltaLight* delta_lights, const __global Emitter* emitters,
                            __global float* film, uint first_x, uint first_y, uint columns, uint rows, uint first_sample) {
  if (get_global_id(0) >= columns || get_global_id(1) >= rows)
    return;
  const Lights lights = {params, materials, delta_lights, emitters};
  SampleId id;
  id.pixel = (uint2)(first_x + get_global_id(0), first_y + get_global_id(1));
  id.seed = params->seed;
  const uint count = min(params->samples - first_sample, (uint)GRID_RAYS);
  float x[GRID_RAYS];
  float y[GRID_RAYS];
  float z[GRID_RAYS];
  for (uint k = 0u; k < GRID_RAYS; ++k) {
    id.sample = first_sample + min(k, count - 1u); /* rays beyond the last repeat it, and are not shaded */
    const float2 place = place_in_pixel(id, params->samples, params->jitter != 0u);
    const float3 direction = eye_ray(params, convert_float2(id.pixel) + place).direction;
    x[k] = direction.x;
    y[k] = direction.y;
    z[k] = direction.z;
  }
  Ray ray = eye_ray(params, convert_float2(id.pixel));
  const float3 away = ray.origin - 0.5f;
  const bool is_near = dot3(away, away) < NEAR_CAMERA * NEAR_CAMERA;
  float t[GRID_RAYS];
  uint splat[GRID_RAYS];
  if (is_near) {
    RayPacket packet;
    packet.origin = ray.origin;
    packet.dx0 = vload16(0, x), packet.dx1 = vload16(1, x);
    packet.dy0 = vload16(0, y), packet.dy1 = vload16(1, y);
    packet.dz0 = vload16(0, z), packet.dz1 = vload16(1, z);
    packet.t_min = ray.t_min;
    packet.t_max = ray.t_max;
    const PacketHits hits = trace_packet(POOL_ARGS, &packet);
    vstore16(hits.t0, 0, t), vstore16(hits.t1, 1, t);
    vstore16(hits.splat0, 0, splat), vstore16(hits.splat1, 1, splat);
  }
  float sums[FILM_SUMS];
  for (int c = 0; c < FILM_SUMS; ++c)
    sums[c] = 0.0f;
  uint point = FILM_NO_POINT;
  for (uint k = 0u; k < count; ++k) {
    id.sample = first_sample + k;
    ray.direction = (float3)(x[k], y[k], z[k]);
    uint found;
    if (is_near) {
      const Hit hit = {t[k], splat[k]};
      found = add_sample(POOL_ARGS, lights, id, ray, 0.0f, hit, sums);
    } else {
      found = add_traced_sample(POOL_ARGS, lights, id, ray, sums);
    }
    point = point == FILM_NO_POINT ? found : point;
  }
  __global float* pixel = film + FILM_CHANNELS * (get_global_id(1) * (size_t)columns + get_global_id(0));
  for (int c = 0; c < FILM_SUMS; ++c)
    pixel[c] = first_sample == 0u ? sums[c] : pixel[c] + sums[c];
  if (first_sample == 0u || as_uint(pixel[FILM_POINT]) == FILM_NO_POINT)
    pixel[FILM_POINT] = as_float(point);
}
