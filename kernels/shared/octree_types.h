#ifndef POINTGI_SHARED_OCTREE_TYPES_H
#define POINTGI_SHARED_OCTREE_TYPES_H
#include "shared/scalar.h"
#include "shared/traversal_types.h"
/* The three pools of the octree as the device reads them (method.md section 2). Positions and lengths are in units of
 * the root cube, [0,1)^3. All children of a node are stored, empty ones too, next to each other along x + N*y + N*N*z.
 */

#define NODE_EMPTY 0u    /* no splat touches the cell */
#define NODE_LEAF 1u     /* owns an entry in the Begin-End pool */
#define NODE_INTERNAL 2u /* owns N^3 children */

#define NODE_TYPE(header) ((header) >> 30)
#define NODE_LEVEL(header) (((header) >> 24) & 63u)
#define NODE_HEADER(type, level) (((type) << 30) | ((level) << 24))

/* Finest cell of the tree: 2^MAX_AXIS_BITS a side. A Morton key holds 3*21 bits, and a float in [0,1) holds 21 bits of
 * a coordinate exactly, which exact stepping needs. */
#define MAX_AXIS_BITS 21

/* Node pool: one 128-bit texel a node. */
typedef struct OctreeNode {
  pg_uint header;  /* bytes 0-3: bits 31-30 type, 29-24 level (root 0), 23-0 zero */
  pg_uint address; /* bytes 4-7: internal: pool index of the first child; leaf: index of beginP in the Begin-End pool;
                      empty: 0 */
  pg_uint extra;   /* bytes 8-11: leaf: number of extra splats; internal: index of the first own point; empty: 0 */
  pg_uint count;   /* bytes 12-15: own points of the leaf, or of the subtree; empty: 0 */
} OctreeNode;

/* Begin-End pool, 4-byte entries: a leaf's beginP (index of its first own point), then the addresses of its extra
 * splats; the entry behind them is the next leaf's beginP, and thereby this leaf's endP. The last leaf is followed by
 * one closing entry, the number of points.
 * Where a splat is clipped (HAS_CLIPS) the pool begins with an entry for each point: where the CLIP_WORDS words of its
 * DiscClip begin in this pool, or 0; the clips follow, then the leaves. */

/* Point pool: 44 bytes a point in three 16-byte texels; the twelfth scalar carries the effective area. Of patches
 * (HAS_MLS) a PatchBend follows as a fourth. */
#ifdef HAS_MLS
#define POINT_TEXELS 4
#else
#define POINT_TEXELS 3
#endif
typedef struct OctreePoint {
  float position[3]; /* texel 0, bytes 0-11: root cube */
  float radius;      /* texel 0, bytes 12-15: splat radius, root cube */
  float normal[3];   /* texel 1, bytes 16-27: unit */
  float material;    /* texel 1, bytes 28-31: index into the materials, a whole number below MOST_MATERIALS, plus
                        SHEET_FRONT or SHEET_BACK where the point is a side of a sheet, plus FLAT where it is flat */
  float colour[3];   /* texel 2, bytes 32-43: diffuse reflectance rho, linear RGB, [0,1] */
  float area;        /* texel 2, bytes 44-47: effective area A_i, root cube squared */
} OctreePoint;

/* A splat of a two-sided material is two points that follow each other in the pool and differ in their normals alone:
 * the front of the sheet, then its back. A ray meets both at the same t, and sees the one that faces it. */
#define SHEET_FRONT 0.25f
#define SHEET_BACK 0.5f
#define SHEET_SIDE(material) (0.25f * (float)((pg_uint)((material)*4.0f) & 3u))

/* A splat of a shape whose faces are planes: its disc lies in the true surface, and sticks out of it nowhere. Kernels
 * heed it where HAS_CLIPS: such shapes have borders. */
#define FLAT 0.125f
#define IS_FLAT(material) (((pg_uint)((material)*8.0f) & 1u) != 0u)
#define MOST_MATERIALS 2097152u /* 2^21: below it a float holds the eighths */

/* Where a splat's disc ends before its rim does: at the border of what it stands for, two strips across each other in
 * the disc's plane. A hit counts where low <= axis . (hit - centre) <= high holds of both. */
#define CLIP_STRIPS 2
typedef struct ClipStrip {
  float axis[3];   /* words 0-2: unit, across the disc's normal; 0 in a strip that cuts nothing off */
  float low, high; /* words 3-4: root cube; low <= 0 <= high */
} ClipStrip;
typedef struct DiscClip {
  ClipStrip strip[CLIP_STRIPS];
} DiscClip;
#define STRIP_WORDS 5
#define CLIP_WORDS (CLIP_STRIPS * STRIP_WORDS)

/* Borders that meet reach past each other by this much, root cube units, or rays would get through between them: as far
 * as a ray starts behind its surface, and what the border's own place is rounded by. radius: of the disc. */
#define CLIP_MARGIN(radius) (SEGMENT_MARGIN(radius) + 1e-7f)

/* How a splat's patch of the moving-least-squares surface (HAS_MLS) stands off its disc: at x u + y v from the centre,
 * (u, v) being the tangents of the normal, by x (xx x + xy y) + yy y y along the normal. It ends where its disc does,
 * and at PATCH_HEIGHT. All 0: the disc itself. */
typedef struct PatchBend {
  float xx, xy, yy; /* texel 3, bytes 0-11: 1 / root cube */
  float reserved;   /* texel 3, bytes 12-15: 0 */
} PatchBend;

/* How far off its disc a patch reaches, in radii of the disc: half of its box's height. */
#define PATCH_HEIGHT 0.5f
/* Square of the radius of a ball about the centre that holds every patch, in radii of the disc: 1 + PATCH_HEIGHT
 * squared, and rounding. */
#define PATCH_REACH2 1.2501f

/* The wide form of the same octree (N = 2): a node keeps the boxes of what its children really hold, radii included, so
 * a splat lies in one leaf only and no cell is listed. Boxes are widened by a little more than a hit's rounding. */
#define WIDE_CHILDREN 8
typedef struct WideNode {
  float low[3][WIDE_CHILDREN];  /* bytes 0-95: x of all children, then y, then z; an empty child's box is inverted */
  float high[3][WIDE_CHILDREN]; /* bytes 96-191 */
  pg_uint child[WIDE_CHILDREN]; /* bytes 192-223: node index, or WIDE_LEAF | blocks << 24 | first block; empty: 0 */
} WideNode;
#define WIDE_LEAF 0x80000000u       /* bit 31 */
#define WIDE_MAX_BLOCKS 127u        /* bits 30-24: blocks of a leaf */
#define WIDE_BLOCK_MASK 0x00ffffffu /* bits 23-0: its first block */

/* A leaf's splats in blocks of WIDE_LANES (8 or 16), structure of arrays, 32-bit words:
 *   0..3L-1 centre x, y, z;  3L..4L-1 radius (-1 in unused lanes);  4L..7L-1 normal x, y, z;  7L index of the block's
 *   first point in the point pool, the others follow it;  7L+1 a bit for each lane that is a side of a sheet;
 *   7L+2 a bit for each lane whose splat is clipped;  7L+3 the word of the pool at which their DiscClips begin, lane
 *   after lane;  7L+4 a bit for each lane whose splat is flat;  7L+5..8L-1 zero
 * Of patches 8L..11L-1 follow: xx, xy and yy of their PatchBends. The clips stand behind all blocks. */
#define WIDE_DISC_BLOCK_WORDS(lanes) (8 * (lanes))
#define WIDE_PATCH_BLOCK_WORDS(lanes) (11 * (lanes))
#ifdef __OPENCL_VERSION__ /* on the host the pools say which (octree/pack/wide_pools.h) */
#ifdef HAS_MLS
#define WIDE_BLOCK_WORDS WIDE_PATCH_BLOCK_WORDS
#else
#define WIDE_BLOCK_WORDS WIDE_DISC_BLOCK_WORDS
#endif
#endif
#define WIDE_CENTRE(lanes, axis) ((axis) * (lanes))
#define WIDE_RADIUS(lanes) (3 * (lanes))
#define WIDE_NORMAL(lanes, axis) ((4 + (axis)) * (lanes))
#define WIDE_FIRST(lanes) (7 * (lanes))
#define WIDE_SHEETS(lanes) (7 * (lanes) + 1)
#define WIDE_CLIPPED(lanes) (7 * (lanes) + 2)
#define WIDE_CLIPS(lanes) (7 * (lanes) + 3)
#define WIDE_FLAT(lanes) (7 * (lanes) + 4)
#define WIDE_BEND(lanes, term) ((8 + (term)) * (lanes))

/* Deepest wide tree that a traversal's stack holds: seven waiting siblings a level. */
#define WIDE_MAX_DEPTH 27
#define WIDE_STACK (7 * WIDE_MAX_DEPTH + 1)

#endif
