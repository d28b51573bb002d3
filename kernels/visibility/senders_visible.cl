/* Which senders each receiver sees: a ray a receiver and sender (method.md section 8).
 *   MONTE_CARLO  of each window of senders each receiver asks for the one that it picks in this pass
 *   else         the receivers ask for all senders of a table */
#include "shared/pair_types.h"
#include "visibility/sight.cl"
#ifdef MONTE_CARLO
#include "lib/window_pick.cl"
#define SENDER_PARAMS const __global uint2 *restrict windows, const __global uint *restrict members
#else
#define SENDER_PARAMS const __global OctreePoint *restrict senders
#endif

#ifndef SENDERS_AT_ONCE
#define SENDERS_AT_ONCE 64u /* of a work-item */
#endif

/* Bits of receivers of the table `points` and their senders (SenderRows).
 * NDRange: 2-D, padded: SENDERS_AT_ONCE senders a column, row at.first_row + y of at.rows.
 *   senders  where they are seen: places, normals, radii and areas
 *   seen     rows from at.held_from on
 *   rays     grows by the number of rays traced */
__kernel OWN_VECTORS void senders_visible(SIGHT_PARAMS, const __global OctreePoint* points, SENDER_PARAMS, SenderRows at,
                              __global uchar* seen, __global uint* rays) {
  const uint first = SENDERS_AT_ONCE * get_global_id(0), row = at.first_row + get_global_id(1);
  if (first >= at.senders || get_global_id(1) >= at.rows)
    return;
  const uint end = min(first + SENDERS_AT_ONCE, at.senders);
  const uint receivers = min((uint)FMM_LANES, at.receivers - FMM_LANES * row);
  __global uchar* seen_by = seen + (ulong)(row - at.held_from) * at.senders;
  uint traced = 0u;
  for (uint s = first; s < end; ++s) {
    uint lanes = 0u;
    for (uint q = 0u; q < receivers; ++q) {
      const uint receiver = FMM_LANES * row + q;
#ifdef MONTE_CARLO
      /* From the lower index to the higher, as pairs_visible: what is picked is a term of the sum over all. */
      const uint sender = picked_sender(members, windows[s], receiver, s, at.pass, at.seed);
      const __global OctreePoint* from = points + min(receiver, sender);
      const __global OctreePoint* to = points + max(receiver, sender);
#else
      const __global OctreePoint* from = senders + s;
      const __global OctreePoint* to = points + receiver;
#endif
      if (!may_exchange(from, to))
        continue;
      traced += 1u;
      lanes |= sight_blocked(from, to, at.step_delta) ? 0u : 1u << q;
    }
    seen_by[s] = (uchar)lanes;
  }
  if (traced != 0u)
    atomic_add(rays, traced);
}
