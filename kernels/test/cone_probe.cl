/* Given cones through given voxels (kernels/lib/cone.cl). For tests.
 *   CONE_SIDES  texels a voxel */
#include "lib/cone.cl"

/* NDRange: 1-D, a work-item a cone, padded, of `count`; cones: eight numbers each: the apex, in voxels from the grid's corner,
 * the spread, the unit direction, and one that is not read. seen: as trace_cone gives it, with no receiver's plane. */
__kernel void trace_given_cones(const __global float* cones, uint count, __constant ConeGrid* grid,
                                const __global float4* voxels, const __global uchar* cells, __global float4* seen) {
  const uint id = get_global_id(0);
  const ConeVoxels from = {voxels, cells};
  if (id < count)
    seen[id] = trace_cone(from, grid, load3(cones + 8u * id), load3(cones + 8u * id + 4u), cones[8u * id + 3u], INFINITY, 0.0f);
}
