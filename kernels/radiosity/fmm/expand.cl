/* Moments up the tree, local expansions down, and the field at the points (method.md section 4). A block of FMM_LANES nodes
 * or points of one cluster has FMM_LANES / FMM_ITEM_LANES work-items, which alone write it. Expansions: FMM_VALUES planes of
 * `nodes` numbers, plane 3 * colour + axis.
 *   jobs        one a block: (cluster, first node or point of the block, how many of it count); `count` of them from
 *               `first_job`
 *   positions   of nodes or points: x of all, then y, then z, `nodes` or `points` (both padded) apart */
#include "radiosity/fmm/chebyshev.cl"

/* Nodes of a grid along the three axes, from its packed counts. */
static inline uint3 grid_axes(const __global FmmGrid* grid) {
  return (uint3)(FMM_AXIS(grid->axis, 0), FMM_AXIS(grid->axis, 1), FMM_AXIS(grid->axis, 2));
}

/* What sources at (x, y, z) in grid units, a scalar each, give to the nodes at lanes (ux, uy, uz). */
static inline fmm_lanes spread_weight(uint3 n, fmm_lanes ux, fmm_lanes uy, fmm_lanes uz, float3 at) {
  return chebyshev_weight(n.x, ux, at.x) * chebyshev_weight(n.y, uy, at.y) * chebyshev_weight(n.z, uz, at.z);
}

/* P2M of leaves: moments of block of nodes = sum over the leaf's points of S(node, x_j) B_j A_j n_j. */
__kernel void p2m(const __global uint4* jobs, uint first_job, uint count, const __global FmmCluster* clusters,
                  const __global FmmGrid* grids, uint nodes, const __global float* points, uint point_count,
                  const __global float* flux, __global float* moments) {
  const uint id = FMM_BLOCK;
  if (id >= count)
    return;
  const uint4 job = jobs[first_job + id];
  const __global FmmCluster* cluster = clusters + job.x;
  const __global FmmGrid* grid = grids + job.x;
  const uint3 n = grid_axes(grid);
  fmm_lanes ux, uy, uz;
  nodes_of_block(grid, job.y, &ux, &uy, &uz);
  fmm_lanes sum[FMM_VALUES];
  for (int value = 0; value < FMM_VALUES; ++value)
    sum[value] = 0.0f;
  for (uint j = cluster->first_point; j < cluster->first_point + cluster->count; ++j) {
    const float3 at = (float3)((points[j] - grid->centre[0]) / grid->half_side[0],
                               (points[FMM_PLANE(1, point_count) + j] - grid->centre[1]) / grid->half_side[1],
                               (points[FMM_PLANE(2, point_count) + j] - grid->centre[2]) / grid->half_side[2]);
    const fmm_lanes weight = spread_weight(n, ux, uy, uz, at);
    const float3 normal = (float3)(points[FMM_PLANE(3, point_count) + j], points[FMM_PLANE(4, point_count) + j],
                                   points[FMM_PLANE(5, point_count) + j]);
    for (int c = 0; c < 3; ++c) {
      const float power = flux[FMM_PLANE(c, point_count) + j];
      sum[3 * c] += weight * (power * normal.x);
      sum[3 * c + 1] += weight * (power * normal.y);
      sum[3 * c + 2] += weight * (power * normal.z);
    }
  }
  for (int value = 0; value < FMM_VALUES; ++value)
    store_fmm(sum[value], moments + FMM_PLANE(value, nodes) + job.y);
}

/* M2M: moments of a block of nodes = sum over the nodes of all children. The deeper level must be done. */
__kernel void m2m(const __global uint4* jobs, uint first_job, uint count, const __global FmmCluster* clusters,
                  const __global FmmGrid* grids, const __global float* node_positions, uint nodes,
                  __global float* moments) {
  const uint id = FMM_BLOCK;
  if (id >= count)
    return;
  const uint4 job = jobs[first_job + id];
  const __global FmmCluster* cluster = clusters + job.x;
  const __global FmmGrid* grid = grids + job.x;
  const uint3 n = grid_axes(grid);
  fmm_lanes ux, uy, uz;
  nodes_of_block(grid, job.y, &ux, &uy, &uz);
  fmm_lanes sum[FMM_VALUES];
  for (int value = 0; value < FMM_VALUES; ++value)
    sum[value] = 0.0f;
  for (uint child = cluster->first_child; child < cluster->first_child + cluster->child_count; ++child) {
    const uint3 cn = grid_axes(grids + child);
    const uint from = grids[child].first, to = from + cn.x * cn.y * cn.z;
    for (uint m = from; m < to; ++m) {
      const float3 at = (float3)((node_positions[m] - grid->centre[0]) / grid->half_side[0],
                                 (node_positions[FMM_PLANE(1, nodes) + m] - grid->centre[1]) / grid->half_side[1],
                                 (node_positions[FMM_PLANE(2, nodes) + m] - grid->centre[2]) / grid->half_side[2]);
      const fmm_lanes weight = spread_weight(n, ux, uy, uz, at);
      for (int value = 0; value < FMM_VALUES; ++value)
        sum[value] += weight * moments[FMM_PLANE(value, nodes) + m];
    }
  }
  for (int value = 0; value < FMM_VALUES; ++value)
    store_fmm(sum[value], moments + FMM_PLANE(value, nodes) + job.y);
}

/* Sums of local expansions of `grid` at lanes (x, y, z), added to sum[]. */
static inline void interpolate(const __global FmmGrid* grid, const __global float* local_values, uint nodes, fmm_lanes x,
                               fmm_lanes y, fmm_lanes z, fmm_lanes* sum) {
  const uint3 n = grid_axes(grid);
  const fmm_lanes tx = in_grid(grid, 0, x), ty = in_grid(grid, 1, y), tz = in_grid(grid, 2, z);
  uint m = grid->first;
  for (uint k = 0u; k < n.z; ++k) {
    const fmm_lanes wz = chebyshev_weight(n.z, tz, chebyshev_node(n.z, k));
    for (uint j = 0u; j < n.y; ++j) {
      const fmm_lanes wyz = wz * chebyshev_weight(n.y, ty, chebyshev_node(n.y, j));
      for (uint i = 0u; i < n.x; ++i, ++m) {
        const fmm_lanes weight = wyz * chebyshev_weight(n.x, tx, chebyshev_node(n.x, i));
        for (int value = 0; value < FMM_VALUES; ++value)
          sum[value] += weight * local_values[FMM_PLANE(value, nodes) + m];
      }
    }
  }
}

/* L2L: a block of nodes takes its parent's expansion, too. The level above must be done. */
__kernel void l2l(const __global uint4* jobs, uint first_job, uint count, const __global FmmCluster* clusters,
                  const __global FmmGrid* grids, const __global float* node_positions, uint nodes,
                  __global float* local_values) {
  const uint id = FMM_BLOCK;
  if (id >= count)
    return;
  const uint4 job = jobs[first_job + id];
  fmm_lanes sum[FMM_VALUES];
  for (int value = 0; value < FMM_VALUES; ++value)
    sum[value] = load_fmm(local_values + FMM_PLANE(value, nodes) + job.y);
  interpolate(grids + clusters[job.x].parent, local_values, nodes, load_fmm(node_positions + job.y),
              load_fmm(node_positions + nodes + job.y), load_fmm(node_positions + FMM_PLANE(2, nodes) + job.y), sum);
  for (int value = 0; value < FMM_VALUES; ++value)
    store_fmm(sum[value], local_values + FMM_PLANE(value, nodes) + job.y);
}

/* L2P: irradiance[colour * point_count + i] = -(1/pi) n_i . F(x_i) [W/m^2] of a block of a leaf's points. */
__kernel void l2p(const __global uint4* jobs, uint first_job, uint count, const __global FmmGrid* grids, uint nodes,
                  const __global float* points, uint point_count, const __global float* local_values,
                  __global float* irradiance) {
  const uint id = FMM_BLOCK;
  if (id >= count)
    return;
  const uint4 job = jobs[first_job + id];
  fmm_lanes field[FMM_VALUES];
  for (int value = 0; value < FMM_VALUES; ++value)
    field[value] = 0.0f;
  interpolate(grids + job.x, local_values, nodes, load_fmm(points + job.y), load_fmm(points + point_count + job.y),
              load_fmm(points + FMM_PLANE(2, point_count) + job.y), field);
  const fmm_lanes nx = load_fmm(points + FMM_PLANE(3, point_count) + job.y),
                  ny = load_fmm(points + FMM_PLANE(4, point_count) + job.y),
                  nz = load_fmm(points + FMM_PLANE(5, point_count) + job.y);
  for (uint c = 0u; c < 3u; ++c) {
    const fmm_lanes h = -INVERSE_PI * (nx * field[3u * c] + ny * field[3u * c + 1u] + nz * field[3u * c + 2u]);
    store_block(h, irradiance + FMM_PLANE(c, point_count) + job.y, job.z);
  }
}
