/* Visibility between points, for the V-map (method.md section 3).
 * NDRange: 1-D, one work-item a segment, padded; work-items past `count` do nothing. */
#include "visibility/segment.cl"

/* blocked[i] = 1 when something stands between the points segments[i].from and .to of the table `points`, else 0. The
 * table is apart from the pools: it holds only the points that exchange light, in the order of their clusters. */
__kernel OWN_VECTORS void segments_blocked(POOL_PARAMS, const __global OctreePoint* points, const __global SegmentQuery* segments,
                               __global uchar* blocked, uint count, float step_delta) {
  const uint i = get_global_id(0);
  if (i < count)
    blocked[i] = segment_blocked(POOL_ARGS, points + segments[i].from, points + segments[i].to, step_delta) ? 1 : 0;
}
