/* Interpolation on Chebyshev nodes of the first kind, as fmm/operators/chebyshev.h:
 * S_n(t, u) = 1/n + 2/n sum_k T_k(t) T_k(u). A grid of one node along an axis has S = 1. */
#include "radiosity/fmm/lanes.cl"

/* Node m of n in [-1, 1]. */
static inline float chebyshev_node(uint n, uint m) { return cospi((2.0f * (float)m + 1.0f) / (2.0f * (float)n)); }

/* S_n(t, u) of lanes t and one u: what the value at u counts at each t, or what a value at t gives the node u. */
static inline fmm_lanes chebyshev_weight(uint n, fmm_lanes t, float u) {
  fmm_lanes before_t = 1.0f, at_t = t, sum = 0.0f;
  float before_u = 1.0f, at_u = u;
  for (uint k = 1u; k < n; ++k) {
    sum += at_t * at_u;
    const fmm_lanes next_t = 2.0f * t * at_t - before_t;
    const float next_u = 2.0f * u * at_u - before_u;
    before_t = at_t;
    at_t = next_t;
    before_u = at_u;
    at_u = next_u;
  }
  return (1.0f + 2.0f * sum) / (float)n;
}

/* Places of a block of a grid's nodes along x, y and z, [-1, 1]. Not from their positions: of a small or flat cluster's
 * box floats have too few steps, and the weights would not sum to 1. */
static inline void nodes_of_block(const __global FmmGrid* grid, uint first_node, fmm_lanes* x, fmm_lanes* y,
                                  fmm_lanes* z) {
  const int nx = (int)FMM_AXIS(grid->axis, 0), ny = (int)FMM_AXIS(grid->axis, 1), nz = (int)FMM_AXIS(grid->axis, 2);
  const fmm_mask k = min(FMM_LANE_NUMBERS + (int)(first_node - grid->first), nx * ny * nz - 1);
  *x = cospi(fmm_float(2 * (k % nx) + 1) / (2.0f * (float)nx));
  *y = cospi(fmm_float(2 * (k / nx % ny) + 1) / (2.0f * (float)ny));
  *z = cospi(fmm_float(2 * (k / (nx * ny)) + 1) / (2.0f * (float)nz));
}

/* A place in a grid's own units, [-1, 1] along each axis. */
static inline fmm_lanes in_grid(const __global FmmGrid* grid, int axis, fmm_lanes x) {
  return (x - grid->centre[axis]) / grid->half_side[axis];
}
