/* Irradiance of the points from every point that they see, a pair at a time (method.md section 4): the exact solver. */
#include "radiosity/fmm/exchange.cl"

#ifndef DIRECT_SOURCES
#define DIRECT_SOURCES 256u /* summed apart: n terms of about the same size one by one lose sqrt(n) roundings in float */
#endif

/* irradiance[colour * stride + i] += sum over senders j of v_ij F_ij B_j, v_ij a bit, first_sender <= j < end_sender. Senders
 * are summed in blocks of DIRECT_SOURCES, and blocks one by one: the same bits for any division at their borders.
 * NDRange: 1-D, a work-item a block of FMM_LANES receivers, padded: row first_row + i of `rows`.
 *   seen     byte j - first_sender of a row, `row_bytes` long, is the block as sender j sees it, the lowest bit its first
 *            point (kernels/visibility/pairs.cl, kernels/visibility/senders_visible.cl); the buffer begins with row
 *            held_from; bits of points past the last are zero
 *   points   the receivers, as receivers_at reads them, planes `stride` apart
 *   senders  their planes, sender_stride apart; `flux` too */
__kernel void receive_from_all(uint first_row, uint rows, const __global uchar* seen, uint held_from, uint row_bytes,
                               uint first_sender, uint end_sender, const __global float* points, uint stride,
                               const __global float* senders, const __global float* flux, uint sender_stride,
                               __global float* irradiance) {
  const uint id = get_global_id(0);
  if (id >= rows)
    return;
  const uint row = first_row + id;
  const __global uchar* seen_by = seen + (ulong)(row - held_from) * row_bytes;
  Receivers r = receivers_at(points, stride, FMM_LANES * row);
  __global float* to = irradiance + FMM_LANES * row;
  fmm_lanes red = load_fmm(to), green = load_fmm(to + stride), blue = load_fmm(to + FMM_PLANE(2, stride));
  for (uint first = first_sender; first < end_sender; first += DIRECT_SOURCES) {
    const uint end = min(first + DIRECT_SOURCES, end_sender);
    for (uint j = first; j < end; ++j) {
      const int lanes = seen_by[j - first_sender];
      if (lanes == 0)
        continue;
      const fmm_lanes factor = exchange_with_point(&r, senders + j, sender_stride) * INVERSE_PI;
      receive_flux(&r, select((fmm_lanes)(0.0f), factor, (((fmm_mask)(lanes) >> FMM_LANE_NUMBERS) & 1) != 0), flux,
                   sender_stride, j);
    }
    red += r.red, green += r.green, blue += r.blue;
    r.red = 0.0f, r.green = 0.0f, r.blue = 0.0f;
  }
  store_fmm(red, to);
  store_fmm(green, to + stride);
  store_fmm(blue, to + FMM_PLANE(2, stride));
}
