#ifndef POINTGI_SHARED_TRAVERSAL_TYPES_H
#define POINTGI_SHARED_TRAVERSAL_TYPES_H
#include "shared/scalar.h"
/* A ray and its answer, for the kernels that trace given rays (kernels/traverse). Root cube units. */

typedef struct RayQuery {
  float origin[3];    /* bytes 0-11 */
  float t_min;        /* bytes 12-15: hits at t <= t_min do not count */
  float direction[3]; /* bytes 16-27: unit */
  float t_max;        /* bytes 28-31: hits at t >= t_max do not count */
} RayQuery;

#define NO_SPLAT 0xffffffffu
/* Of what a point sees in a direction (kernels/radiosity/directions): the back of some splat. */
#define BACK_SEEN (NO_SPLAT - 1u)

typedef struct RayAnswer {
  float t;       /* bytes 0-3: distance of the hit, or t_max */
  pg_uint splat; /* bytes 4-7: index into the point pool, or NO_SPLAT */
} RayAnswer;

/* Rays of one origin that are traced together: 2 x 2 pixels of 8 x 4 rays, pixel after pixel, a component of all rays
 * side by side. Any other rays of one origin will do; those of a pixel, and of half a pixel, should run close together.
 */
#define PACKET_COLUMNS 2
#define PACKET_ROWS 2
#define PACKET_RAYS (32 * PACKET_COLUMNS * PACKET_ROWS)

typedef struct RayPacketQuery {
  float direction[3][PACKET_RAYS]; /* bytes 0-1535: unit */
  float origin[3];                 /* bytes 1536-1547 */
  float t_min;                     /* bytes 1548-1551: not negative */
  float t_max;                     /* bytes 1552-1555 */
  pg_uint reserved[11];            /* bytes 1556-1599 */
} RayPacketQuery;

typedef struct RayPacketAnswer {
  float t[PACKET_RAYS];       /* bytes 0-511 */
  pg_uint splat[PACKET_RAYS]; /* bytes 512-1023 */
} RayPacketAnswer;

/* Rays off as many surfaces that are traced together, where they run close together (kernels/traverse/wide_beam.cl). */
#define BEAM_RAYS 16

/* Overlapping discs stick out of the surface they stand for, so a ray that leaves a surface would meet its neighbours'
 * rims. A hit is taken for the surface itself, not for a blocker, when it lies within reach of the end and not high
 * above it, in units of the two discs' radii, and its disc faces the same way. A wall across, or the far side of a
 * sheet of any thickness, blocks at any distance, so corners and contacts do not leak; what lies parallel before a
 * surface, a picture or a lamp, blocks where the gap is wider than one and a half of their radii (a height of 0.5, one
 * radius, shows specks on the terraces of depth cameras). Of a flat splat (FLAT), which sticks out of no surface, a hit
 * is taken so at no height but that of rounding: a lamp shadows the ceiling however close it hangs. */
#define SELF_HIT_REACH 1.5f
#define SELF_HIT_HEIGHT 0.75f
#define SELF_HIT_COSINE 0.5f /* 60 degrees: more than a crease inside one surface, less than a corner of a box */
/* Of a sheet (SHEET_FRONT) the side that faces against an end is the surface there as well, if the one that faces the
 * same way is, and if the end is no higher than this above the disc's plane, in units of the two discs' radii: a sheet
 * may bend as much as one that has one side, and of two sheets the other blocks where they lie more than half a radius
 * apart. */
#define SHEET_HEIGHT 0.25f
/* Of a ray that carries light from surface to surface, a disc near its origin is met when the ray arrives at its front:
 * the surface is hollow there. Were it passed by, light would get out through the walls of what is closed: the inside
 * of a sphere of 25 splats across and albedo 0.9 is then 7 % too dark. Nearer than this, in units of the disc's radius,
 * it is rounding that puts a disc before its surface. */
#define ARRIVAL_DISTANCE 0.1f
/* Lengths that stand for rounding are a hundredth of the radii at hand, so that a small object in a large cube is
 * closed as it would be alone; never less than what coordinates near 1 and hits are rounded by, some 2^-21, and never
 * more than `most`. */
#define ROUNDING_OF_HITS 5e-7f
#define ROUNDING_MARGIN(radii, most)                                                                                   \
  ((radii)*0.01f < ROUNDING_OF_HITS ? ROUNDING_OF_HITS : (radii)*0.01f > (most) ? (most) : (radii)*0.01f)

/* A sheet stored as two coincident sides: the other side is the surface itself as long as it lies within rounding.
 * radii: those of the two discs together. */
#define MOST_COINCIDENT 1e-5f
#define COINCIDENT(radii) ROUNDING_MARGIN(radii, MOST_COINCIDENT)

/* A segment between two points is traced from a little before its start to a little behind its end: where two walls
 * meet, rounding may put a point a few float steps beyond the other wall, and light would leak along the edge. A ray
 * off a surface starts as far behind it. radii: those of the discs at its ends. */
#define MOST_SEGMENT_MARGIN 4e-6f
#define SEGMENT_MARGIN(radii) ROUNDING_MARGIN(radii, MOST_SEGMENT_MARGIN)

/* The height above an end up to which a flat splat (FLAT) is that end's surface: what a ray starts behind it, and
 * rounding. */
#define FLAT_HEIGHT (MOST_SEGMENT_MARGIN + ROUNDING_OF_HITS)

/* A question of the V-map: does anything stand between two points? */
typedef struct SegmentQuery {
  pg_uint from, to; /* bytes 0-7: indices into the table of points, OctreePoints */
} SegmentQuery;

#endif
