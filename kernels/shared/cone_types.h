#ifndef POINTGI_SHARED_CONE_TYPES_H
#define POINTGI_SHARED_CONE_TYPES_H
#include "shared/scalar.h"
/* Voxel cone tracing (method.md section 8): a pyramid of voxels over the splats, and the cones that are traced in it.
 * A voxel keeps densities, per volume: of surface, and of the flux B A that leaves it. Lengths in and of the pyramid
 * are in sides of a finest voxel. */

/* A voxel is so many texels (x, y, z: flux density of R, G, B; w: density of surface). With one, all surface counts
 * alike and shines to all sides. With six, texel 2 a is what faces along the axis a, 2 a + 1 what faces against it,
 * each weighted by the cosine of its normal with the axis. */
#define CONE_SIDES_ISOTROPIC 1u
#define CONE_SIDES_ANISOTROPIC 6u

#define CONE_MOST_LEVELS 9 /* 256 voxels a side, and 8 times half as many */

/* Level k has (side >> k)^3 voxels, x fastest, and around them one layer of empty ones: samples at the border need no
 * test. */
typedef struct ConeGrid {
  float origin[3];                 /* bytes 0-11: least corner, root cube */
  float voxel;                     /* bytes 12-15: side of a finest voxel, root cube */
  pg_uint side_log2;               /* bytes 16-19: finest voxels a side */
  pg_uint cone_count;              /* bytes 20-23: cones a receiver */
  pg_uint first[CONE_MOST_LEVELS]; /* bytes 24-59: first voxel of each level, its border included */
  pg_uint reserved;
} ConeGrid;
#define CONE_GRID_LEVELS(grid) ((grid)->side_log2 + 1u)

/* One of the cones of a receiver, about the receiver's normal z. */
typedef struct Cone {
  float axis[3]; /* bytes 0-11: unit */
  float spread;  /* bytes 12-15: diameter over distance, 2 tan(half angle) */
  float share;   /* bytes 16-19: of the irradiance; all add up to 1 */
  pg_uint reserved[3];
} Cone;

/* A splat's part in a voxel. */
typedef struct VoxelShare {
  pg_uint voxel; /* bytes 0-3: x + side (y + side z) of the finest level */
  float area;    /* bytes 4-7: of the splat's effective area, in sides of a finest voxel squared */
} VoxelShare;

#endif
