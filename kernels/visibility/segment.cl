/* Whether light goes from point to point: the one rule of the V-map and of the direct solver. */
#include "traverse/traversal.cl"

/* Whether something stands between two points. The splats of the pools block, all but those of the surfaces at the two
 * ends (OcclusionEnds). Points in one place see each other. */
static inline bool segment_blocked(POOL_PARAMS, const __global OctreePoint* from, const __global OctreePoint* to,
                                   float step_delta) {
  Ray ray;
  ray.origin = load3(from->position);
  ray.direction = load3(to->position) - ray.origin;
  const float distance = sqrt(dot3(ray.direction, ray.direction));
  if (distance == 0.0f)
    return false;
  ray.direction /= distance;
  const float margin = SEGMENT_MARGIN(from->radius + to->radius);
  ray.t_min = -margin;
  ray.t_max = distance + margin;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  const OcclusionEnds ends = {load3(from->normal), load3(to->normal), from->radius, to->radius};
  return trace_any(POOL_ARGS, ray, ends);
}
