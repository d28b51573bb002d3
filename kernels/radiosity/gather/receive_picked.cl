/* Irradiance of the points from the senders that they picked in a pass (method.md section 8). */
#include "radiosity/fmm/exchange.cl"
#include "lib/window_pick.cl"

/* irradiance[colour * stride + i] = sum over windows w of v count(w) F B of the sender that i has picked of w: unbiased, as
 * each of the window's is as likely.
 * NDRange: 1-D, a work-item a block of FMM_LANES receivers, padded: row first_row + i of `rows`.
 *   seen    of senders_visible in the same pass, with the same seed; the buffer begins with row held_from
 *   points  planes `stride` apart, which receivers and senders are of, and `flux` */
__kernel void receive_from_picked(uint first_row, uint rows, const __global uchar* seen, uint held_from,
                                  const __global uint2* windows, const __global uint* members, uint window_count,
                                  uint pass, uint seed, const __global float* points, const __global float* flux,
                                  uint stride, __global float* irradiance) {
  const uint id = get_global_id(0);
  if (id >= rows)
    return;
  const uint row = first_row + id;
  const __global uchar* seen_by = seen + (ulong)(row - held_from) * window_count;
  Receivers r = receivers_at(points, stride, FMM_LANES * row);
  for (uint w = 0u; w < window_count; ++w)
    for (uint lanes = seen_by[w]; lanes != 0u; lanes &= lanes - 1u) {
      const int lane = (int)popcount((lanes & (0u - lanes)) - 1u);
      const uint2 window = windows[w];
      const uint j = picked_sender(members, window, FMM_LANES * row + lane, w, pass, seed);
      const fmm_lanes factor = exchange_with_point(&r, points + j, stride) * (INVERSE_PI * (float)window.y);
      receive_flux(&r, select((fmm_lanes)(0.0f), factor, FMM_LANE_NUMBERS == lane), flux, stride, j);
    }
  __global float* to = irradiance + FMM_LANES * row;
  store_fmm(r.red, to);
  store_fmm(r.green, to + stride);
  store_fmm(r.blue, to + FMM_PLANE(2, stride));
}
