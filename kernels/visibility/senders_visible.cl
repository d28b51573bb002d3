/* Which senders each receiver sees: a ray a receiver and sender (method.md section 8).
 *   MONTE_CARLO  of each window of senders each receiver asks for the one that it picks in this pass
 *   else         the receivers ask for all senders of a table */
#include "visibility/sight.cl"
#ifdef MONTE_CARLO
#include "lib/window_pick.cl"
#define SENDER_PARAMS const __global uint2 *restrict windows, const __global uint *restrict members, uint pass, uint seed
#define SENDER(receiver, s) (points + picked_sender(members, windows[s], receiver, s, pass, seed))
#else
#define SENDER_PARAMS const __global OctreePoint *restrict senders
#define SENDER(receiver, s) (senders + (s))
#endif

#ifndef SENDERS_AT_ONCE
#define SENDERS_AT_ONCE 64u /* of a work-item */
#endif

/* seen[(row - held_from) * sender_count + s] has bit q set when the points FMM_LANES row + q of `points` and the sender s may
 * exchange light and see each other.
 * NDRange: 2-D, padded: SENDERS_AT_ONCE senders a column, row first_row + y of `rows`.
 *   senders  where they are seen: places, normals, radii and areas
 *   rays     grows by the number of rays traced */
__kernel void senders_visible(SIGHT_PARAMS, const __global OctreePoint* points, uint point_count, SENDER_PARAMS,
                              uint sender_count, uint first_row, uint rows, __global uchar* seen, uint held_from,
                              __global uint* rays, float step_delta) {
  const uint first = SENDERS_AT_ONCE * get_global_id(0), row = first_row + get_global_id(1);
  if (first >= sender_count || get_global_id(1) >= rows)
    return;
  const uint end = min(first + SENDERS_AT_ONCE, sender_count);
  const uint receivers = min((uint)FMM_LANES, point_count - FMM_LANES * row);
  __global uchar* seen_by = seen + (ulong)(row - held_from) * sender_count;
  uint traced = 0u;
  for (uint s = first; s < end; ++s) {
    uint lanes = 0u;
    for (uint q = 0u; q < receivers; ++q) {
      const uint receiver = FMM_LANES * row + q;
      const __global OctreePoint* sender = SENDER(receiver, s);
      if (!may_exchange(points + receiver, sender))
        continue;
      traced += 1u;
      lanes |= sight_blocked(sender, points + receiver, step_delta) ? 0u : 1u << q;
    }
    seen_by[s] = (uchar)lanes;
  }
  if (traced != 0u)
    atomic_add(rays, traced);
}
