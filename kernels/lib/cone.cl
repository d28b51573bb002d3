/* One cone through the pyramid of voxels (shared/cone_types.h), front to back: C += a2 c, a += a2, with the step's part
 * a2 = min(CONE_COVER w step, 1 - a) of a density of surface w, which shines with the mean radiosity c = flux / w. Samples are as
 * wide as the cone, between two levels and eight voxels of each. Interpolation and means of densities keep their integral: a
 * closed surface across the cone adds up to CONE_COVER at whatever offset, angle and level, and a part f of one to
 * CONE_COVER f. Opacities that multiply, as those of fog, would let through what falls between two layers of voxels, or cover
 * too much where surfaces end.
 *   CONE_SIDES  texels a voxel */
#include "lib/vector.cl"
#include "shared/cone_types.h"

#ifndef CONE_SIDES
#define CONE_SIDES 6
#endif
#ifndef CONE_COVER
#define CONE_COVER 1.3f /* more than 1: voxels share a slanting surface unevenly, and some of its places add up to less */
#endif
#ifndef CONE_LIFT
#define CONE_LIFT 1.5f /* voxels that a cone's apex is moved along the receiver's normal: as far as its own voxel reaches */
#endif
#ifndef CONE_CLEARANCE
#define CONE_CLEARANCE 0.5f /* widest sample, by its height above the receiver's plane: wider ones meet the receiver's own surface */
#endif
#ifndef CONE_STEP
#define CONE_STEP 1.0f /* by the width of a sample: interpolated over twice that, samples add up to the whole density */
#endif
#define CONE_LEAST_CLEARNESS 0.01f /* the cone ends where a > 0.99 */

/* What the pyramid holds. */
typedef struct ConeVoxels {
  const __global float4* voxels;
  const __global uchar* cells; /* where a sample's eight voxels begin with this one: 0 where all of them are empty */
} ConeVoxels;

/* What a sample finds: flux towards the viewer and surface that faces him, and surface that faces away. */
typedef struct ConeSample {
  float4 facing;
  float away;
} ConeSample;

/* The texels that a ray in a direction meets from the front, and by how much. */
typedef struct ConeView {
  float3 cosine;
  uint3 facing;
} ConeView;

static inline ConeView cone_view(float3 direction) {
  ConeView view;
  view.cosine = fabs(direction);
  view.facing = (uint3)(direction.x > 0.0f ? 1u : 0u, direction.y > 0.0f ? 3u : 2u, direction.z > 0.0f ? 5u : 4u);
  return view;
}

/* Adds shares of a voxel, of what faces the viewer and of what faces away. */
static inline void add_voxel(const __global float4* voxels, uint voxel, float facing, float away, ConeView view,
                             ConeSample* sample) {
#if CONE_SIDES == 1
  sample->facing += facing * voxels[voxel];
#else
  const __global float4* texels = voxels + (size_t)CONE_SIDES * voxel;
  sample->facing += facing * (view.cosine.x * texels[view.facing.x] + view.cosine.y * texels[view.facing.y] +
                              view.cosine.z * texels[view.facing.z]);
  if (away > 0.0f)
    sample->away += away * (view.cosine.x * texels[view.facing.x ^ 1u].w + view.cosine.y * texels[view.facing.y ^ 1u].w +
                            view.cosine.z * texels[view.facing.z ^ 1u].w);
#endif
}

/* Adds shares of what a level holds at a place, voxels from the grid's corner: between eight voxels. */
static inline void add_level(ConeVoxels from, __constant ConeGrid* grid, uint level, float3 at, float facing, float away,
                             ConeView view, ConeSample* sample) {
  const uint side = (1u << grid->side_log2) >> level, row = side + 2u;
  /* The middle of voxel i is at i + 0.5; with the border it is number i + 1. */
  const float3 place = clamp(at / (float)(1u << level) + 0.5f, 0.0f, (float)side + 1.0f);
  const float3 low = fmin(floor(place), (float)side), part = place - low, rest = 1.0f - part;
  const uint voxel = grid->first[level] + ((uint)low.z * row + (uint)low.y) * row + (uint)low.x;
  if (from.cells[voxel] == 0)
    return;
  for (uint k = 0u; k < 8u; ++k) {
    const float share = (k & 1u ? part.x : rest.x) * (k & 2u ? part.y : rest.y) * (k & 4u ? part.z : rest.z);
    const uint corner = voxel + ((k >> 2u) * row + (k >> 1u & 1u)) * row + (k & 1u);
    add_voxel(from.voxels, corner, share * facing, share * away, view, sample);
  }
}

/* At a place, as wide as `width` >= 1 voxels: flux towards the viewer, and density of surface, between two levels. Of closed
 * bodies as much faces away as faces the viewer, and lies behind it; only what more faces away is black and hides what is
 * behind. It comes from the finer level alone: the coarser one reaches back to the receiver's own surface. */
static inline float4 cone_density(ConeVoxels from, __constant ConeGrid* grid, float3 at, float width, ConeView view) {
  const float number = clamp(log2(width), 0.0f, (float)grid->side_log2);
  const uint level = min((uint)number, grid->side_log2);
  const float next = number - (float)level;
  ConeSample sample;
  sample.facing = (float4)(0.0f);
  sample.away = 0.0f;
  add_level(from, grid, level, at, 1.0f - next, 1.0f, view, &sample);
  if (next > 0.0f)
    add_level(from, grid, level + 1u, at, next, 0.0f, view, &sample);
  return (float4)(sample.facing.xyz, fmax(sample.facing.w, sample.away));
}

/* What a cone sees from `apex`, in voxels from the grid's corner: xyz mean radiosity (radiance times pi) times opacity, w
 * opacity.
 *   height, rise  the samples' height above the plane of the receiver, at the apex and per distance */
static inline float4 trace_cone(ConeVoxels from, __constant ConeGrid* grid, float3 apex, float3 direction, float spread,
                                float height, float rise) {
  const ConeView view = cone_view(direction);
  const float side = (float)(1u << grid->side_log2);
  float3 seen = (float3)(0.0f);
  float clear = 1.0f, t = 0.0f;
  while (clear > CONE_LEAST_CLEARNESS) {
    const float width = fmax(1.0f, fmin(spread * t, CONE_CLEARANCE * fma(rise, t, height))), step = CONE_STEP * width;
    const float3 place = fma((float3)(t + 0.5f * step), direction, apex);
    /* Wide samples reach the voxels from outside. */
    if (!all(place > -width) || !all(place < side + width))
      break;
    const float4 density = cone_density(from, grid, place, width, view);
    if (density.w > 0.0f) {
      const float opacity = fmin(CONE_COVER * density.w * step, clear);
      seen += opacity / density.w * density.xyz;
      clear -= opacity;
    }
    t += step;
  }
  return (float4)(seen, 1.0f - clear);
}

/* Where a surface's cones begin, voxels from the grid's corner. */
static inline float3 cone_apex(__constant ConeGrid* grid, float3 position, float3 normal) {
  return fma((float3)(CONE_LIFT), normal, (position - load3_constant(grid->origin)) / grid->voxel);
}

/* Irradiance [W/m2] of a surface by a receiver's cones, turned about the normal; each stands for the same share of the light. */
static inline float3 cone_irradiance(ConeVoxels from, __constant ConeGrid* grid, __constant Cone* cones,
                                     float3 position, float3 normal, float turn) {
  const float3 at = cone_apex(grid, position, normal);
  float3 u, v, sum = (float3)(0.0f);
  tangents(normal, &u, &v);
  const float c = cos(turn), s = sin(turn);
  const float3 a = c * u + s * v, b = c * v - s * u;
  for (uint k = 0u; k < grid->cone_count; ++k) {
    const float3 axis = load3_constant(cones[k].axis);
    sum += cones[k].share *
           trace_cone(from, grid, at, axis.x * a + axis.y * b + axis.z * normal, cones[k].spread, CONE_LIFT, axis.z).xyz;
  }
  return sum;
}
