/* Irradiance of the points from every point that they see, a pair at a time (method.md section 4): the exact solver. */
#include "lib/pair_tiles.cl"
#include "radiosity/fmm/exchange.cl"

/* irradiance[colour * stride + i] += sum over j of v_ij F_ij B_j, v_ij a bit of a tile of the band: of a row in it, all j of
 * columns before held_end; of a row before it, the j of its columns, which are the band's rows. Senders are summed square
 * by square, SENDERS_SUMMED of them, and squares one by one: band after band gives the same bits for any bands.
 * NDRange: 1-D, FMM_LANES / FMM_ITEM_LANES work-items a row of FMM_LANES receivers, padded: at.rows rows from at.first_row.
 *   tiles   of the band, as pairs_visible writes them (PairRows); bits of points past the last are zero
 *   points  planes at.stride apart, as receivers_at reads them; `flux` too */
__kernel void receive_from_all(PairRows at, const __global ulong* tiles, const __global float* points,
                               const __global float* flux, __global float* irradiance) {
  if (FMM_BLOCK >= at.rows)
    return;
  const uint row = at.first_row + FMM_BLOCK;
  Receivers r = receivers_at(points, at.stride, FMM_LANES * row);
  Irradiance sum = irradiance_at(irradiance, at.stride, FMM_LANES * row);
  const ulong before = PAIR_TILES(at.held_from / SQUARE_TILES);
  for (uint first = row < at.held_from ? at.held_from : 0u; first < at.held_end; first += SQUARE_TILES) {
    const uint end = min(first + SQUARE_TILES, at.held_end);
    const bool mirrored = first > row; /* the square is that of the row and column exchanged */
    const __global ulong* tile = tiles + ((mirrored ? PAIR_TILE(first, row) : PAIR_TILE(row, first)) - before);
    for (uint column = first; column < end; ++column, tile += mirrored ? SQUARE_TILES : 1) {
      ulong seen = *tile;
      if (mirrored && seen + 1ul > 1ul) /* neither none nor all, which are their own mirror images */
        seen = mirrored_tile(seen);
      for (uint j = FMM_LANES * column; seen != 0ul; seen >>= FMM_LANES, ++j)
        receive_from_sender(&r, (int)(seen & 255ul), points, flux, at.stride, j);
    }
    add_received(&sum, &r);
  }
  store_irradiance(&sum, irradiance, at.stride, FMM_LANES * row);
}
