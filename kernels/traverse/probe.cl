/* Probes: what the device itself makes of shared structs and small functions. For tests. */
#include "lib/octree_descent.cl"
#include "lib/rng.cl"
#include "shared/photon_types.h"
#include "shared/render_types.h"
#include "shared/traversal_types.h"

#define OFFSET(type, field) ((uint)(size_t) & (((__private type*)0)->field))

/* One work-item. sizes[...] = sizeof and offsets of the shared structs as the device lays them out. */
__kernel void probe_layout(__global uint* sizes) {
  sizes[0] = sizeof(OctreeNode);
  sizes[1] = OFFSET(OctreeNode, address);
  sizes[2] = OFFSET(OctreeNode, extra);
  sizes[3] = OFFSET(OctreeNode, count);
  sizes[4] = sizeof(OctreePoint);
  sizes[5] = OFFSET(OctreePoint, radius);
  sizes[6] = OFFSET(OctreePoint, normal);
  sizes[7] = OFFSET(OctreePoint, material);
  sizes[8] = OFFSET(OctreePoint, colour);
  sizes[9] = OFFSET(OctreePoint, area);
  sizes[10] = sizeof(Camera);
  sizes[11] = sizeof(RenderParams);
  sizes[12] = OFFSET(RenderParams, environment);
  sizes[13] = OFFSET(RenderParams, samples);
  sizes[14] = OFFSET(RenderParams, emitters);
  sizes[15] = OFFSET(RenderParams, step_delta);
  sizes[16] = sizeof(DeltaLight);
  sizes[17] = OFFSET(DeltaLight, strength);
  sizes[18] = OFFSET(DeltaLight, cumulative);
  sizes[19] = sizeof(Emitter);
  sizes[20] = sizeof(Material);
  sizes[21] = sizeof(RayQuery);
  sizes[22] = sizeof(RayAnswer);
  sizes[23] = sizeof(RayPacketQuery);
  sizes[24] = OFFSET(RayPacketQuery, t_max);
  sizes[25] = sizeof(RayPacketAnswer);
  sizes[26] = sizeof(EyeHits);
  sizes[27] = sizeof(SegmentQuery);
}

/* nodes[i] = the leaf or empty node that holds positions[i] (xyz), for i < count. */
__kernel void probe_descent(POOL_PARAMS, const __global float4* positions, __global uint4* nodes, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    nodes[i] = octree_descend(POOL_ARGS, positions[i].xyz);
}

/* values[i] = pcg4d(i, i, i, i) for i < count. */
__kernel void probe_rng(__global uint4* values, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    values[i] = pcg4d((uint4)(i));
}
