/* Whether two points see each other, by the way that was chosen: SIGHT_PARAMS, sight_blocked(from, to, step_delta), and
 * whether there is anything to see.
 *   VISIBILITY_VOXELS  by marching through an occupancy grid of so many voxels a side; else by a ray */
#include "lib/vector.cl"
#include "shared/fmm_types.h"
#include "shared/octree_types.h"
#ifdef VISIBILITY_VOXELS
#include "visibility/voxels.cl"
#define SIGHT_PARAMS const __global uint *restrict occupancy
#define sight_blocked(from, to, step_delta) voxels_blocked(occupancy, from, to)
#else
#include "visibility/segment.cl"
#define SIGHT_PARAMS POOL_PARAMS
#define sight_blocked(from, to, step_delta) segment_blocked(POOL_ARGS, from, to, step_delta)
#endif

/* Whether one of the two may give the other anything: they face each other, or, where a source is so close that it is
 * four quarters of its disc (FMM_CLOSE), its middle at least does not hide behind its own side. */
static inline bool may_exchange(const __global OctreePoint* a, const __global OctreePoint* b) {
  const float3 r = load3(b->position) - load3(a->position);
  const float before_a = dot3(load3(a->normal), r), before_b = -dot3(load3(b->normal), r), r2 = dot3(r, r);
  return before_a > 0.0f ? before_b > 0.0f || r2 < FMM_CLOSE * a->area : before_b > 0.0f && r2 < FMM_CLOSE * b->area;
}
