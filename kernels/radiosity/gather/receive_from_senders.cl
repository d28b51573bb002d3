/* Irradiance of the points from a table of senders (method.md section 8). */
#include "radiosity/fmm/exchange.cl"
#include "shared/pair_types.h"

/* irradiance[colour * stride + i] = sum over senders s of v_is F_is B_s, in blocks of SENDERS_SUMMED.
 * NDRange: 1-D, FMM_LANES / FMM_ITEM_LANES work-items a row of FMM_LANES receivers, padded: at.rows rows from at.first_row.
 *   seen     bits of senders_visible (SenderRows)
 *   points   the receivers, as receivers_at reads them, planes at.stride apart
 *   senders  their planes, at.sender_stride apart; `flux` too */
__kernel void receive_from_senders(SenderRows at, const __global uchar* seen, const __global float* points,
                                   const __global float* senders, const __global float* flux, __global float* irradiance) {
  if (FMM_BLOCK >= at.rows)
    return;
  const uint row = at.first_row + FMM_BLOCK;
  const __global uchar* seen_by = seen + (ulong)(row - at.held_from) * at.senders;
  Receivers r = receivers_at(points, at.stride, FMM_LANES * row);
  Irradiance sum = {0.0f, 0.0f, 0.0f};
  for (uint first = 0u; first < at.senders; first += SENDERS_SUMMED) {
    const uint end = min(first + SENDERS_SUMMED, at.senders);
    for (uint j = first; j < end; ++j)
      receive_from_sender(&r, seen_by[j], senders, flux, at.sender_stride, j);
    add_received(&sum, &r);
  }
  store_irradiance(&sum, irradiance, at.stride, FMM_LANES * row);
}
