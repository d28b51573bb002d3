/* Light into the finest voxels, and means of it upwards. NDRange of both kernels: 1-D, a work-item a voxel that holds
 * surface, padded: occupied[first] and following, below `end`, each x + side (y + side z) of its level.
 *   CONE_SIDES  texels a voxel (shared/cone_types.h) */
#include "lib/vector.cl"
#include "shared/cone_types.h"
#include "shared/octree_types.h"

#ifndef CONE_SIDES
#define CONE_SIDES 6
#endif

/* Where a level's voxel stands among all. */
static inline __global float4* voxel_at(__global float4* voxels, __constant ConeGrid* grid, uint level, uint3 at) {
  const uint row = ((1u << grid->side_log2) >> level) + 2u;
  const uint voxel = grid->first[level] + ((at.z + 1u) * row + at.y + 1u) * row + at.x + 1u;
  return voxels + (size_t)CONE_SIDES * voxel;
}

static inline uint3 place_of(uint number, uint side_log2) {
  const uint mask = (1u << side_log2) - 1u;
  return (uint3)(number & mask, number >> side_log2 & mask, number >> 2u * side_log2);
}

/* Texels of a finest voxel: sums over its splats of flux and area (that faces a side), over the volume 1.
 *   begin      [voxels of the level + 1] where the shares of each begin
 *   splats     the splat of each share
 *   areas      and its area in the voxel, in sides of it squared
 *   radiosity  B of each splat [W/m2]; w unused */
__kernel OWN_VECTORS void inject_light(const __global uint* occupied, uint first, uint end, __constant ConeGrid* grid,
                           const __global uint* begin, const __global uint* splats, const __global float* areas,
                           const __global OctreePoint* points, const __global float4* radiosity, __global float4* voxels) {
  const uint id = first + get_global_id(0);
  if (id >= end)
    return;
  float4 texel[CONE_SIDES];
  for (int side = 0; side < CONE_SIDES; ++side)
    texel[side] = (float4)(0.0f);
  for (uint k = begin[id]; k < begin[id + 1u]; ++k) {
    const float4 light = areas[k] * (float4)(radiosity[splats[k]].xyz, 1.0f);
#if CONE_SIDES == 1
    texel[0] += light;
#else
    const float3 n = load3(points[splats[k]].normal);
    texel[0] += fmax(n.x, 0.0f) * light;
    texel[1] += fmax(-n.x, 0.0f) * light;
    texel[2] += fmax(n.y, 0.0f) * light;
    texel[3] += fmax(-n.y, 0.0f) * light;
    texel[4] += fmax(n.z, 0.0f) * light;
    texel[5] += fmax(-n.z, 0.0f) * light;
#endif
  }
  __global float4* voxel = voxel_at(voxels, grid, 0u, place_of(occupied[id], grid->side_log2));
  for (int side = 0; side < CONE_SIDES; ++side)
    voxel[side] = texel[side];
}

/* A voxel of `level` >= 1 is the mean of the eight that divide it: the level below must be done. */
__kernel OWN_VECTORS void average_children(const __global uint* occupied, uint first, uint end, __constant ConeGrid* grid, uint level,
                               __global float4* voxels) {
  const uint id = first + get_global_id(0);
  if (id >= end)
    return;
  const uint3 at = place_of(occupied[id], grid->side_log2 - level);
  __global float4* voxel = voxel_at(voxels, grid, level, at);
  for (int side = 0; side < CONE_SIDES; ++side) {
    float4 sum = (float4)(0.0f);
    for (uint k = 0u; k < 8u; ++k)
      sum += voxel_at(voxels, grid, level - 1u, 2u * at + (uint3)(k & 1u, k >> 1u & 1u, k >> 2u))[side];
    voxel[side] = 0.125f * sum;
  }
}
