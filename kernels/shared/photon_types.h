#ifndef POINTGI_SHARED_PHOTON_TYPES_H
#define POINTGI_SHARED_PHOTON_TYPES_H
#include "shared/scalar.h"
/* Photons and the map they are kept in (method.md section 5). Lengths are in root cube units; powers are W over the
 * cube's side squared, scaled as RenderParams: a power over an area is then an irradiance as the kernels have it. */

typedef struct Photon {
  float position[3]; /* bytes 0-11: root cube */
  pg_uint inward;    /* bytes 12-15: against the normal of the surface, on the side that it came to, packed as below */
  float power[3];    /* bytes 16-27: times PhotonFlight::radiance_factor */
  pg_uint splat;     /* bytes 28-31: that it was stored on */
} Photon;

/* A component c of a direction is the signed whole number nearest to c * PHOTON_DIRECTION_SCALE, in bits 0-9 (x), 10-19
 * (y) and 20-29 (z): which side of a surface it comes from is all that is asked of it. */
#define PHOTON_DIRECTION_SCALE 511.0f

/* Splats of specular material (mirror, conductor, glass, Phong) that photons are aimed at together. */
typedef struct PhotonLeaf {
  float centre[3]; /* bytes 0-11: root cube */
  float radius;    /* bytes 12-15: of a sphere that holds the whole discs */
  pg_uint first;   /* bytes 16-19: its splats in the list of all leaves' splats */
  pg_uint count;   /* bytes 20-23 */
} PhotonLeaf;
#define NO_PHOTON_LEAF 0xffffffffu

/* Photons of one light for one leaf. */
typedef struct EmissionBatch {
  pg_uint first;  /* bytes 0-3: number of its first photon */
  pg_uint count;  /* bytes 4-7 */
  pg_uint source; /* bytes 8-11: a point or directional light, or SOURCE_... */
  pg_uint leaf;   /* bytes 12-15 */
  float share; /* bytes 16-19: of what the light sends into the leaf's sphere, for each photon; with equal power: each
                  photon's luminance */
} EmissionBatch;
#define SOURCE_EMITTERS 0xfffffffeu
#define SOURCE_ENVIRONMENT 0xfffffffdu

/* How a photon ended. */
#define PHOTON_MISSED 0u   /* met another leaf, which sends it itself, or none: it counts for nothing */
#define PHOTON_STORED 1u   /* met a diffuse surface */
#define PHOTON_ABSORBED 2u /* nothing was left of it */
#define PHOTON_ESCAPED 3u  /* met nothing any more */
#define PHOTON_CUT 4u      /* had as many bounces as there may be */
#define PHOTON_ENDS 5
#define PHOTON_MOST_BOUNCES 64u

typedef struct PhotonFlight {
  float position[3];     /* bytes 0-11: where it was stored, root cube */
  pg_uint inward;        /* bytes 12-15: as Photon's */
  float power[3];        /* bytes 16-27: at its end */
  pg_uint end;           /* bytes 28-31 */
  float emitted[3];      /* bytes 32-43: power when it set out */
  float radiance_factor; /* bytes 44-47: what the eye makes of its power where it was stored: light of radiance L in
                 glass of index n is carried as L / n^2 on the eye's way (kernels/materials/materials.cl), so (n where
                 it set out / n here)^2 */
  float absorbed[3];     /* bytes 48-59: what its surfaces and glass took on the way, less what chance gave */
  pg_uint splat;         /* bytes 60-63: that it met last; of the pool */
} PhotonFlight;

/* The map is a left-balanced kd-tree over buckets of PHOTON_LANES photons. Three binary levels make one node of
 * eight children, so that a node's boxes are one set of vectors. All buckets lie equally deep; node i has the children
 * 8 i + 1 ... 8 i + 8, so nothing points anywhere; the nodes over the buckets begin at (8^(levels-1) - 1) / 7, and
 * bucket 8 j + c is child c of the j-th of them. Every bucket but the last is full. */
#define PHOTON_LANES 16
#define PHOTON_CHILDREN 8
#define PHOTON_MAX_LEVELS 8 /* 8^8 buckets: more than there can be photons */
typedef struct PhotonNode {
  float low[3][PHOTON_CHILDREN];  /* bytes 0-95: boxes of the children's photons; of one that is not there inverted */
  float high[3][PHOTON_CHILDREN]; /* bytes 96-191 */
} PhotonNode;

/* A bucket in 32-bit words, a lane a photon: x, y, z, inward, then power red, green, blue. Lanes without a photon
 * stand at PHOTON_NOWHERE. */
#define PHOTON_WORDS 7
#define PHOTON_BUCKET_WORDS (PHOTON_WORDS * PHOTON_LANES)
#define PHOTON_NOWHERE 1e18f /* squared it is still finite, and farther than PHOTON_FARTHEST2 */
#define PHOTON_FARTHEST2 1e30f

/* Places in a row that a work-item of nearest_of_places takes: each tells the next where to look. */
#define PHOTON_PLACES_AT_ONCE 64

/* How photons are gathered. */
typedef struct GatherParams {
  pg_uint levels; /* bytes 0-3: of the map's nodes; 0: no photon */
  pg_uint k;      /* bytes 4-7: photons an estimate */
  float radius2;  /* bytes 8-11: photons this far or farther do not count; at most PHOTON_FARTHEST2 */
  pg_uint pad0;
} GatherParams;

#endif
