/* Irradiance of the points from every point that they see, a pair at a time (method.md section 4): the exact solver. */
#include "radiosity/fmm/exchange.cl"

#ifndef DIRECT_SOURCES
#define DIRECT_SOURCES 256u /* summed apart: n terms of about the same size one by one lose sqrt(n) roundings in float */
#endif

/* irradiance[colour * stride + i] = sum over all points j of v_ij F_ij B_j, v_ij a bit.
 * NDRange: 1-D, a work-item a block of FMM_LANES receivers, padded: row first_row + i of `rows`.
 *   seen    byte j of a row, `row_bytes` long, is the block as source j sees it, the lowest bit its first point
 *           (kernels/visibility/pairs.cl); the buffer begins with row held_from; rows end with zeros from `points` on
 *   points  as receivers_at and receive_flux read them; `point_count` of them count */
__kernel void receive_from_all(uint first_row, uint rows, const __global uchar* seen, uint held_from, uint row_bytes,
                               const __global float* points, uint point_count, uint stride,
                               const __global float* flux, __global float* irradiance) {
  const uint id = get_global_id(0);
  if (id >= rows)
    return;
  const uint row = first_row + id;
  const __global uchar* seen_by = seen + (ulong)(row - held_from) * row_bytes;
  Receivers r = receivers_at(points, stride, FMM_LANES * row);
  fmm_lanes red = 0.0f, green = 0.0f, blue = 0.0f;
  for (uint first = 0u; first < point_count; first += DIRECT_SOURCES) {
    const uint end = min(first + DIRECT_SOURCES, point_count);
    for (uint j = first; j < end; ++j) {
      const int lanes = seen_by[j];
      if (lanes == 0)
        continue;
      const fmm_lanes factor = exchange_with_point(&r, points + j, stride) * INVERSE_PI;
      receive_flux(&r, select((fmm_lanes)(0.0f), factor, (((fmm_mask)(lanes) >> FMM_LANE_NUMBERS) & 1) != 0), flux,
                   stride, j);
    }
    red += r.red, green += r.green, blue += r.blue;
    r.red = 0.0f, r.green = 0.0f, r.blue = 0.0f;
  }
  __global float* to = irradiance + FMM_LANES * row;
  store_fmm(red, to);
  store_fmm(green, to + stride);
  store_fmm(blue, to + FMM_PLANE(2, stride));
}
