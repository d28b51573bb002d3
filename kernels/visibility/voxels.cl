/* Visibility by marching through a grid of occupied voxels (method.md section 8): rough, and blind to what is smaller than
 * a voxel. */
#include "lib/vector.cl"
#include "shared/octree_types.h"

/* Ends are moved off their surfaces by this many voxels, or the voxels that the surfaces themselves lie in would block. */
#define VOXELS_OFF_SURFACE 1.5f

static inline int voxel_at(float place) {
  return clamp((int)floor(place), 0, VISIBILITY_VOXELS - 1);
}

/* A march along one axis. */
typedef struct AxisMarch {
  int at, last, step;
  float next, length; /* of the way: where the next border is, and from border to border */
} AxisMarch;

/* From `start` on, `way` along the axis, in voxels. */
static inline AxisMarch march_along(float start, float way) {
  AxisMarch m;
  m.at = voxel_at(start);
  m.last = voxel_at(start + way);
  m.step = way > 0.0f ? 1 : -1;
  m.length = 1.0f / fmax(fabs(way), 1e-20f);
  m.next = fabs((float)(m.at + (way > 0.0f ? 1 : 0)) - start) * m.length;
  return m;
}

/* Whether a voxel between those of the two ends is occupied; those of the ends do not count. Voxel i holds i <= x < i + 1
 * voxels; it is bit (z VISIBILITY_VOXELS + y) VISIBILITY_VOXELS + x. From border to border (Amanatides and Woo, 1987). In
 * scalars: with vectors of three PoCL 3.1's compiler crashes. */
static inline bool voxels_blocked(const __global uint* occupancy, const __global OctreePoint* from,
                                  const __global OctreePoint* to) {
  const float3 start = (float)VISIBILITY_VOXELS * load3(from->position) + VOXELS_OFF_SURFACE * load3(from->normal);
  const float3 end = (float)VISIBILITY_VOXELS * load3(to->position) + VOXELS_OFF_SURFACE * load3(to->normal);
  AxisMarch x = march_along(start.x, end.x - start.x), y = march_along(start.y, end.y - start.y),
            z = march_along(start.z, end.z - start.z);
  for (int k = 0; k < 3 * VISIBILITY_VOXELS; ++k) {
    if (fmin(x.next, fmin(y.next, z.next)) >= 1.0f)
      return false;
    if (x.next <= y.next && x.next <= z.next)
      x.at += x.step, x.next += x.length;
    else if (y.next <= z.next)
      y.at += y.step, y.next += y.length;
    else
      z.at += z.step, z.next += z.length;
    if ((x.at == x.last && y.at == y.last && z.at == z.last) || (uint)x.at >= VISIBILITY_VOXELS ||
        (uint)y.at >= VISIBILITY_VOXELS || (uint)z.at >= VISIBILITY_VOXELS)
      return false;
    const uint bit = (uint)((z.at * VISIBILITY_VOXELS + y.at) * VISIBILITY_VOXELS + x.at);
    if ((occupancy[bit >> 5] >> (bit & 31u) & 1u) != 0u)
      return true;
  }
  return false;
}
