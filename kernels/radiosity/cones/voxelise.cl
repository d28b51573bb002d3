/* Which voxels a splat's disc overlaps, and by how much (method.md section 8). The disc is an octagon of its area, which the
 * planes of the voxels cut; a voxel gets the share of the effective area A_i that the cut has in the whole. All shares of a
 * splat add up to A_i. What lies in a plane between two voxels belongs to the upper one. */
#include "lib/vector.cl"
#include "shared/cone_types.h"
#include "shared/octree_types.h"

#define DISC_CORNERS 8
#define POLYGON_MOST (DISC_CORNERS + 6) /* a cut by a plane adds a corner at most */
/* An octagon of corner distance r OCTAGON_REACH has the area pi r^2. */
#define OCTAGON_REACH 1.0539047f

typedef struct Polygon {
  float corner[POLYGON_MOST][3];
  uint corners;
} Polygon;

/* The part of a convex polygon where the coordinate is >= bound, or (below) < bound. */
static inline void cut_polygon(const Polygon* from, int axis, float bound, bool below, Polygon* to) {
  to->corners = 0u;
  for (uint k = 0u; k < from->corners; ++k) {
    const float* p = from->corner[k];
    const float* q = from->corner[k + 1u < from->corners ? k + 1u : 0u];
    const bool p_in = (p[axis] >= bound) != below, q_in = (q[axis] >= bound) != below;
    if (p_in) {
      for (int a = 0; a < 3; ++a)
        to->corner[to->corners][a] = p[a];
      ++to->corners;
    }
    if (p_in != q_in) {
      const float s = (bound - p[axis]) / (q[axis] - p[axis]);
      for (int a = 0; a < 3; ++a)
        to->corner[to->corners][a] = fma(s, q[a] - p[a], p[a]);
      ++to->corners;
    }
  }
}

static inline float polygon_area(const Polygon* polygon) {
  float3 sum = (float3)(0.0f);
  const float3 o = vload3(0, polygon->corner[0]);
  for (uint k = 2u; k < polygon->corners; ++k)
    sum += cross(vload3(0, polygon->corner[k - 1u]) - o, vload3(0, polygon->corner[k]) - o);
  return 0.5f * sqrt(dot3(sum, sum));
}

/* Area of the polygon, whose corners are relative to `centre`, in the voxel. */
static inline float area_in_voxel(const Polygon* whole, const float* centre, const int* voxel) {
  Polygon one = *whole, other;
  for (int a = 0; a < 3; ++a) {
    cut_polygon(&one, a, (float)voxel[a] - centre[a], false, &other);
    cut_polygon(&other, a, (float)(voxel[a] + 1) - centre[a], true, &one);
  }
  return one.corners < 3u ? 0.0f : polygon_area(&one);
}

static inline uint add_share(const int* voxel, uint side_log2, float area, __global VoxelShare* shares, uint most, uint count) {
  if (shares != 0 && count < most) {
    shares[count].voxel = (((uint)voxel[2] << side_log2 | (uint)voxel[1]) << side_log2) | (uint)voxel[0];
    shares[count].area = area;
  }
  return count + 1u;
}

/* The number of voxels that the splat overlaps; writes their shares, at most `most`, unless `shares` is 0. */
static inline uint shares_of_splat(const __global OctreePoint* point, __constant ConeGrid* grid, __global VoxelShare* shares,
                                   uint most) {
  const int last = (1 << grid->side_log2) - 1;
  const float scale = 1.0f / grid->voxel, area = point->area * scale * scale;
  float centre[3], normal[3];
  vstore3((load3(point->position) - load3_constant(grid->origin)) * scale, 0, centre);
  vstore3(load3(point->normal), 0, normal);
  float3 u, v;
  tangents(load3(point->normal), &u, &v);
  Polygon disc;
  disc.corners = DISC_CORNERS;
  int low[3] = {last, last, last}, high[3] = {0, 0, 0}, voxel[3];
  for (uint k = 0u; k < DISC_CORNERS; ++k) {
    const float angle = 0.78539816f * ((float)k + 0.5f), reach = OCTAGON_REACH * point->radius * scale;
    const float3 corner = reach * cos(angle) * u + reach * sin(angle) * v;
    vstore3(corner, 0, disc.corner[k]);
    for (int a = 0; a < 3; ++a) {
      const int at = clamp((int)floor(centre[a] + disc.corner[k][a]), 0, last);
      low[a] = min(low[a], at);
      high[a] = max(high[a], at);
    }
  }
  if (low[0] == high[0] && low[1] == high[1] && low[2] == high[2])
    return add_share(low, grid->side_log2, area, shares, most, 0u);
  /* Columns of voxels along the axis that the disc lies most across: it meets few of each. */
  const float3 n = fabs(load3(point->normal));
  const int w = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2, p = (w + 1) % 3, q = (w + 2) % 3;
  const float whole = polygon_area(&disc), slope_p = -normal[p] / normal[w], slope_q = -normal[q] / normal[w];
  const float half_height = 0.5f * (fabs(slope_p) + fabs(slope_q)) + 0.01f;
  uint count = 0u;
  for (voxel[p] = low[p]; voxel[p] <= high[p]; ++voxel[p])
    for (voxel[q] = low[q]; voxel[q] <= high[q]; ++voxel[q]) {
      const float middle = centre[w] + slope_p * ((float)voxel[p] + 0.5f - centre[p]) +
                           slope_q * ((float)voxel[q] + 0.5f - centre[q]);
      const int begin = max(low[w], (int)floor(middle - half_height)), end = min(high[w], (int)floor(middle + half_height));
      for (voxel[w] = begin; voxel[w] <= end; ++voxel[w]) {
        const float part = area_in_voxel(&disc, centre, voxel);
        if (part > 0.0f)
          count = add_share(voxel, grid->side_log2, area * (part / whole), shares, most, count);
      }
    }
  return count;
}

/* NDRange of both: 1-D, a work-item a splat, padded: `first` and following, below `end`. */
__kernel OWN_VECTORS void count_shares(const __global OctreePoint* points, uint first, uint end, __constant ConeGrid* grid,
                           __global uint* counts) {
  const uint i = first + get_global_id(0);
  if (i < end)
    counts[i] = shares_of_splat(points + i, grid, 0, 0u);
}

/* shares[begin[i] - begin[first]] and following, up to those of i + 1: of splat i. Two programs may round a sliver apart:
 * what count_shares saw and this does not is a share of nothing. */
__kernel OWN_VECTORS void write_shares(const __global OctreePoint* points, uint first, uint end, __constant ConeGrid* grid,
                           const __global uint* begin, __global VoxelShare* shares) {
  const uint i = first + get_global_id(0);
  if (i >= end)
    return;
  const uint most = begin[i + 1u] - begin[i];
  __global VoxelShare* of_splat = shares + (begin[i] - begin[first]);
  for (uint k = shares_of_splat(points + i, grid, of_splat, most); k < most; ++k) {
    of_splat[k].voxel = 0u;
    of_splat[k].area = 0.0f;
  }
}
