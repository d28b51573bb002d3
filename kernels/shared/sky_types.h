#ifndef POINTGI_SHARED_SKY_TYPES_H
#define POINTGI_SHARED_SKY_TYPES_H
#include "shared/scalar.h"
/* Light from infinitely far: a latitude-longitude map of radiance [W/m2/sr, scaled as RenderParams], constant on each
 * of its texels. */

/* Row 0 is at the zenith; the middle of the columns looks forward, columns run clockwise as seen from above. */
typedef struct SkyMap {
  float right[3];   /* bytes 0-11: unit vectors of the root cube */
  pg_uint width;    /* bytes 12-15: texels a row */
  float forward[3]; /* bytes 16-27 */
  pg_uint height;   /* bytes 28-31: rows */
  float up[3];      /* bytes 32-43 */
  float pad0;
} SkyMap;

/* Heights are 1 - |cosine of the angle with the zenith|, from the zenith for rows whose index is below height / 2, from
 * the nadir for the others: differences of cosines near 1 would leave a map's first rows no digits. */
typedef struct SkyRow {
  float
      cumulative;  /* bytes 0-3: share of this and all rows above in the sampling, a multiple of 2^-24; the last is 1 */
  float from_pole; /* bytes 4-7: height of the edge nearer to that pole */
  float span;      /* bytes 8-11: > 0: from there to the other edge */
  float solid_angle; /* bytes 12-15: of one texel [sr] */
} SkyRow;

typedef struct SkyTexel {
  float radiance[3]; /* bytes 0-11 */
  float density;     /* bytes 12-15: with which sampling draws a direction in it [1/sr] */
} SkyTexel;

/* A map without bright spots has a coarse one beside it, SMOOTH_SKY_SIDE^2 texels of radiance on the octahedron |x| +
 * |y| + |z| = 1, which takes no arctangents to read: its upper half (z >= 0) in the square's middle, the lower half
 * folded out to its corners. */
#define SMOOTH_SKY_SIDE 64

#endif
