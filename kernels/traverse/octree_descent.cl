/* From a position to the leaf that holds it. */
#ifndef OCTREE_AXIS_BITS
#define OCTREE_AXIS_BITS 1 /* log2 N of the N^d tree */
#endif
#include "lib/pools.cl"
#define OCTREE_N (1 << OCTREE_AXIS_BITS)

/* Descends from the root to the leaf or empty node whose cell holds p, in [0,1)^3: one step a level,
 * n = c + int(p*N), p = p*N - int(p*N) (method.md section 2). All of it is exact in float. */
static inline uint4 octree_descend(POOL_PARAMS, float3 p) {
  uint4 node = pool_node(0);
  while (NODE_TYPE(node.x) == NODE_INTERNAL) {
    const float3 scaled = p * (float)OCTREE_N;
    const int3 child = convert_int3(scaled);
    node = pool_node(node.y + (uint)(child.x + OCTREE_N * (child.y + OCTREE_N * child.z)));
    p = scaled - convert_float3(child);
  }
  return node;
}
