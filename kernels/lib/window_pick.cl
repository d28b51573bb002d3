/* Monte Carlo undersampling: which sender of a window a receiver takes in a pass (method.md section 8). */
#include "lib/rng.cl"

/* One of the window's, each as likely. windows: first of `members`, and how many. */
static inline uint picked_sender(const __global uint* members, uint2 window, uint receiver, uint number, uint pass,
                                 uint seed) {
  const uint4 h = pcg4d((uint4)(receiver, number, 0x50415353u + pass, seed));
  return members[window.x + (uint)(((ulong)h.x * window.y) >> 32)];
}
