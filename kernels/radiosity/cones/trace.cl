/* Irradiance of points by cones through the voxels' light (method.md section 8).
 *   CONE_SIDES  texels a voxel (shared/cone_types.h) */
#include "lib/cone.cl"
#include "shared/octree_types.h"

/* irradiance[3 i ...] [W/m2] of the point places[i] of the table.
 * NDRange: 1-D, a work-item a receiver, padded: `first` and following, below `end`. */
__kernel OWN_VECTORS void trace_cones(const __global OctreePoint* points, const __global uint* places, uint first, uint end,
                          __constant ConeGrid* grid, __constant Cone* cones, const __global float4* voxels,
                          const __global uchar* cells, __global float* irradiance) {
  const uint id = first + get_global_id(0);
  if (id >= end)
    return;
  const __global OctreePoint* point = points + places[id];
  const ConeVoxels from = {voxels, cells};
  /* Unturned: cones turned from point to point leave 2 to 3 times the mottles that they save of bands. */
  const float3 sum = cone_irradiance(from, grid, cones, load3(point->position), load3(point->normal), 0.0f);
  irradiance[3u * id] = sum.x;
  irradiance[3u * id + 1u] = sum.y;
  irradiance[3u * id + 2u] = sum.z;
}
