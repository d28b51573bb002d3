#ifndef POINTGI_SHARED_FMM_TYPES_H
#define POINTGI_SHARED_FMM_TYPES_H
#include "shared/scalar.h"
/* Radiosity (method.md section 4): constants that the far field's kernels share with their twins on the host. */

/* Nodes an axis of an expansion's grid, at most, and the numbers that go with each node: a 3-vector a colour, numbered
 * 3 * colour + axis. */
#define FMM_MAX_ORDER 6
#define FMM_VALUES 9

/* Nodes of a grid and points of a leaf go in blocks of this many; grids are padded to it. */
#define FMM_LANES 8

/* Where a plane begins among planes of `stride` numbers each: nine planes of a large scene's nodes, or seven of its
 * points, are more than 32 bits count. */
#define FMM_PLANE(number, stride) ((pg_ulong)(number) * (stride))

/* A source nearer than sqrt(FMM_CLOSE x its area), about four spacings, is taken as four quarters of its disc; farther
 * off it is a point. No r^2 of a lattice of spacing 1, nor between walls that meet at an edge, is near 16.3, so host
 * and device agree on which is which. */
#define FMM_CLOSE 16.3f

/* Of an entry of a row: all points of the receiver see the same share of the source. Else the place of the share of the
 * receiver's first point among bytes of 1/255, one a point. */
#define NO_POINT_SHARES 0xffffffffu

/* Grid of a cluster's expansions: Chebyshev nodes in a box. */
typedef struct FmmGrid {
  float centre[3];    /* bytes 0-11: root cube */
  float half_side[3]; /* bytes 12-23: > 0 */
  pg_uint axis;  /* bytes 24-27: nodes along x | y << 8 | z << 16, each 1..FMM_MAX_ORDER; node ix + nx (iy + ny iz) */
  pg_uint first; /* bytes 28-31: its first node in the arrays of nodes, a multiple of FMM_LANES */
} FmmGrid;
#define FMM_AXIS(grid_axis, a) (((grid_axis) >> (8 * (a))) & 255u)

/* What the kernels ask of a cluster: as octree/vmap/cluster_tree.h. */
typedef struct FmmCluster {
  pg_uint first_point; /* bytes 0-3 */
  pg_uint count;       /* bytes 4-7 */
  pg_uint first_child; /* bytes 8-11 */
  pg_uint child_count; /* bytes 12-15: 0, a leaf */
  pg_uint parent;      /* bytes 16-19: the root is its own */
} FmmCluster;

/* What the points of a cluster that face one side, or all, are as one flux vector a colour (MID). Which side it shines
 * to is decided by the flux at the linearisation point; where that is the current radiosity, both are equal.
 */
typedef struct FmmFlux {
  float centre[3];                 /* bytes 0-11: centroid weighted by flux */
  float flux[FMM_VALUES];          /* bytes 12-47: sum of B A n, per colour */
  float linearisation[FMM_VALUES]; /* bytes 48-83 */
} FmmFlux;

#endif
