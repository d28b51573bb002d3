/* Visibility between points, for the V-map (method.md section 3).
 * NDRange: 1-D, one work-item a segment, padded; work-items past `count` do nothing. */
#include "lib/traversal.cl"

/* blocked[i] = 1 when something stands between the points segments[i].from and .to of the table `points`, else 0. The
 * splats of the pools block, all but those of the surfaces at the two ends (ShadowEnds). The table is apart from the
 * pools: it holds only the points that exchange light, in the order of their clusters. Points in one place see each
 * other. */
__kernel void segments_blocked(POOL_PARAMS, const __global OctreePoint* points, const __global SegmentQuery* segments,
                               __global uchar* blocked, uint count, float step_delta) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const __global OctreePoint* from = points + segments[i].from;
  const __global OctreePoint* to = points + segments[i].to;
  Ray ray;
  ray.origin = load3(from->position);
  ray.direction = load3(to->position) - ray.origin;
  const float distance = sqrt(dot3(ray.direction, ray.direction));
  if (distance == 0.0f) {
    blocked[i] = 0;
    return;
  }
  ray.direction /= distance;
  ray.t_min = -SEGMENT_MARGIN;
  ray.t_max = distance + SEGMENT_MARGIN;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  const ShadowEnds ends = {load3(from->normal), load3(to->normal), from->radius, to->radius};
  blocked[i] = trace_any(POOL_ARGS, ray, ends) ? 1 : 0;
}
