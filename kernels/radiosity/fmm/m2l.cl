/* M2L: where nearly all of the far field's work is. */
#include "radiosity/fmm/lanes.cl"

/* A block of nodes of a receiving cluster: local = sum over its far sources of v sum_m T(x_m - x) M_m, T M = r (r.M) / r^4.
 * NDRange: 1-D, FMM_LANES / FMM_ITEM_LANES work-items a block, padded. jobs[first_job + i] = (cluster, first node of the
 * block, -, -). Every block has a job, so that all of `local_values` is written. FMM_VALUES planes of `nodes` numbers, plane
 * 3 * colour + axis.
 * far_rows: row of cluster k is [far_begin[k], far_begin[k + 1]) of sources (cluster) and shares v. */
__kernel void m2l(const __global uint4* jobs, uint first_job, uint count, const __global FmmGrid* grids,
                  const __global float* node_positions, uint nodes, const __global uint* far_begin,
                  const __global uint* far_source, const __global float* far_share, const __global float* moments,
                  __global float* local_values) {
  const uint id = FMM_BLOCK;
  if (id >= count)
    return;
  const uint4 job = jobs[first_job + id];
  const fmm_lanes x = load_fmm(node_positions + job.y), y = load_fmm(node_positions + nodes + job.y),
                  z = load_fmm(node_positions + FMM_PLANE(2, nodes) + job.y);
  /* Nine names, not an array: they stay in registers. */
  fmm_lanes rx = 0.0f, ry = 0.0f, rz = 0.0f, gx = 0.0f, gy = 0.0f, gz = 0.0f, bx = 0.0f, by = 0.0f, bz = 0.0f;
  const __global float* mx = node_positions;
  const __global float* my = node_positions + nodes;
  const __global float* mz = node_positions + FMM_PLANE(2, nodes);
  for (uint entry = far_begin[job.x]; entry < far_begin[job.x + 1u]; ++entry) {
    const __global FmmGrid* source = grids + far_source[entry];
    const uint to = source->first + FMM_AXIS(source->axis, 0) * FMM_AXIS(source->axis, 1) * FMM_AXIS(source->axis, 2);
    const float share = far_share[entry];
    for (uint m = source->first; m < to; ++m) {
      const fmm_lanes dx = mx[m] - x, dy = my[m] - y, dz = mz[m] - z;
      const fmm_lanes inverse = 1.0f / (dx * dx + dy * dy + dz * dz);
      const fmm_lanes scale = share * inverse * inverse;
      const __global float* q = moments + m;
      const fmm_lanes r = scale * (dx * q[0] + dy * q[nodes] + dz * q[FMM_PLANE(2, nodes)]);
      const fmm_lanes g =
          scale * (dx * q[FMM_PLANE(3, nodes)] + dy * q[FMM_PLANE(4, nodes)] + dz * q[FMM_PLANE(5, nodes)]);
      const fmm_lanes b =
          scale * (dx * q[FMM_PLANE(6, nodes)] + dy * q[FMM_PLANE(7, nodes)] + dz * q[FMM_PLANE(8, nodes)]);
      rx += dx * r, ry += dy * r, rz += dz * r;
      gx += dx * g, gy += dy * g, gz += dz * g;
      bx += dx * b, by += dy * b, bz += dz * b;
    }
  }
  __global float* to = local_values + job.y;
  store_fmm(rx, to);
  store_fmm(ry, to + nodes);
  store_fmm(rz, to + FMM_PLANE(2, nodes));
  store_fmm(gx, to + FMM_PLANE(3, nodes));
  store_fmm(gy, to + FMM_PLANE(4, nodes));
  store_fmm(gz, to + FMM_PLANE(5, nodes));
  store_fmm(bx, to + FMM_PLANE(6, nodes));
  store_fmm(by, to + FMM_PLANE(7, nodes));
  store_fmm(bz, to + FMM_PLANE(8, nodes));
}
