/* Irradiance of the points from the senders that they picked in a pass (method.md section 8). */
#include "radiosity/fmm/exchange.cl"
#include "lib/window_pick.cl"
#include "shared/pair_types.h"

/* irradiance[colour * stride + i] = sum over windows w of v count(w) F B of the sender that i has picked of w: unbiased, as
 * each of the window's is as likely.
 * NDRange: 1-D, FMM_LANES / FMM_ITEM_LANES work-items a row of FMM_LANES receivers, padded: at.rows rows from at.first_row.
 *   seen    bits of senders_visible in the same pass, with the same seed (SenderRows); a sender a window
 *   points  planes at.stride apart, which receivers and senders are of, and `flux` */
__kernel void receive_from_picked(SenderRows at, const __global uchar* seen, const __global uint2* windows,
                                  const __global uint* members, const __global float* points, const __global float* flux,
                                  __global float* irradiance) {
  if (FMM_BLOCK >= at.rows)
    return;
  const uint row = at.first_row + FMM_BLOCK;
  const __global uchar* seen_by = seen + (ulong)(row - at.held_from) * at.senders;
  Receivers r = receivers_at(points, at.stride, FMM_LANES * row);
  for (uint w = 0u; w < at.senders; ++w)
    for (uint lanes = seen_by[w] & FMM_OWN_BITS; lanes != 0u; lanes &= lanes - 1u) {
      const int lane = (int)popcount((lanes & (0u - lanes)) - 1u);
      const uint2 window = windows[w];
      const uint j = picked_sender(members, window, FMM_LANES * row + lane, w, at.pass, at.seed);
      const fmm_lanes factor = exchange_with_point(&r, points + j, at.stride) * (INVERSE_PI * (float)window.y);
      receive_flux(&r, select((fmm_lanes)(0.0f), factor, FMM_LANE_NUMBERS == lane), flux, at.stride, j);
    }
  Irradiance sum = {0.0f, 0.0f, 0.0f};
  add_received(&sum, &r);
  store_irradiance(&sum, irradiance, at.stride, FMM_LANES * row);
}
