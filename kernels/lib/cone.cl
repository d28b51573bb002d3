/* One cone through the pyramid of voxels (shared/cone_types.h): front to back C += (1 - a) c, a += (1 - a) a2, samples as
 * wide as the cone, between two levels and eight voxels of each. The voxels are taken for a medium: a step through a
 * density of surface w has the opacity 1 - exp(-CONE_DEPTH w step), and shines with the mean radiosity flux / w. A closed
 * surface that lies across the cone has the depth CONE_DEPTH in all, at whatever offset and level: interpolation and
 * means of densities keep their integral.
 *   CONE_SIDES  texels a voxel */
#include "lib/vector.cl"
#include "shared/cone_types.h"

#ifndef CONE_SIDES
#define CONE_SIDES 6
#endif
#ifndef CONE_DEPTH
#define CONE_DEPTH 5.0f /* a closed surface lets exp(-5) = 0.7 % through */
#endif
#ifndef CONE_LIFT
#define CONE_LIFT 1.5f /* voxels that a cone's apex is moved along the receiver's normal: as far as its own voxel reaches */
#endif
#ifndef CONE_CLEARANCE
#define CONE_CLEARANCE 0.35f /* widest sample, by its height above the receiver's plane: wider ones meet the receiver's own surface */
#endif
#ifndef CONE_STEP
#define CONE_STEP 1.0f /* by the width of a sample: interpolated over twice that, samples add up to the whole density */
#endif
#define CONE_LEAST_CLEARNESS 0.01f /* the cone ends where a > 0.99 */

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

static inline void add_voxel(const __global float4* voxels, uint voxel, float share, ConeView view, ConeSample* sample) {
#if CONE_SIDES == 1
  sample->facing += share * voxels[voxel];
#else
  const __global float4* texels = voxels + (size_t)CONE_SIDES * voxel;
  const float3 weight = share * view.cosine;
  sample->facing += weight.x * texels[view.facing.x] + weight.y * texels[view.facing.y] + weight.z * texels[view.facing.z];
  sample->away += weight.x * texels[view.facing.x ^ 1u].w + weight.y * texels[view.facing.y ^ 1u].w +
                  weight.z * texels[view.facing.z ^ 1u].w;
#endif
}

/* Adds `share` of what a level holds at a place, voxels from the grid's corner: between eight voxels. */
static inline void add_level(const __global float4* voxels, __constant ConeGrid* grid, uint level, float3 at, float share,
                             ConeView view, ConeSample* sample) {
  const uint side = (1u << grid->side_log2) >> level, row = side + 2u;
  /* The middle of voxel i is at i + 0.5; with the border it is number i + 1. */
  const float3 place = clamp(at / (float)(1u << level) + 0.5f, 0.0f, (float)side + 1.0f);
  const float3 low = fmin(floor(place), (float)side), part = place - low, rest = 1.0f - part;
  const uint voxel = grid->first[level] + ((uint)low.z * row + (uint)low.y) * row + (uint)low.x;
  const float a = share * rest.z * rest.y, b = share * rest.z * part.y, c = share * part.z * rest.y,
              d = share * part.z * part.y;
  const uint up = voxel + row * row;
  add_voxel(voxels, voxel, a * rest.x, view, sample);
  add_voxel(voxels, voxel + 1u, a * part.x, view, sample);
  add_voxel(voxels, voxel + row, b * rest.x, view, sample);
  add_voxel(voxels, voxel + row + 1u, b * part.x, view, sample);
  add_voxel(voxels, up, c * rest.x, view, sample);
  add_voxel(voxels, up + 1u, c * part.x, view, sample);
  add_voxel(voxels, up + row, d * rest.x, view, sample);
  add_voxel(voxels, up + row + 1u, d * part.x, view, sample);
}

/* At a place, as wide as `width` >= 1 voxels: flux towards the viewer, and density of surface. Of closed bodies as much
 * faces away as faces the viewer, and lies behind it; only what more faces away is black and hides what is behind. */
static inline float4 cone_density(const __global float4* voxels, __constant ConeGrid* grid, float3 at, float width,
                                  ConeView view) {
  const float number = clamp(log2(width), 0.0f, (float)grid->side_log2);
  const uint level = min((uint)number, grid->side_log2);
  const float next = number - (float)level;
  ConeSample sample;
  sample.facing = (float4)(0.0f);
  sample.away = 0.0f;
  add_level(voxels, grid, level, at, 1.0f - next, view, &sample);
  if (next > 0.0f)
    add_level(voxels, grid, level + 1u, at, next, view, &sample);
  return (float4)(sample.facing.xyz, fmax(sample.facing.w, sample.away));
}

/* What a cone sees from `at`, in voxels from the grid's corner: xyz mean radiosity (radiance times pi) times opacity, w
 * opacity.
 *   height, rise  the samples' height above the plane of the receiver, at the apex and per distance */
static inline float4 trace_cone(const __global float4* voxels, __constant ConeGrid* grid, float3 at, float3 direction,
                                float spread, float height, float rise) {
  const ConeView view = cone_view(direction);
  const float side = (float)(1u << grid->side_log2);
  float3 seen = (float3)(0.0f);
  float clear = 1.0f, t = 0.0f;
  while (clear > CONE_LEAST_CLEARNESS) {
    const float width = fmax(1.0f, fmin(spread * t, CONE_CLEARANCE * fma(rise, t, height))), step = CONE_STEP * width;
    const float3 place = fma((float3)(t + 0.5f * step), direction, at);
    /* Wide samples reach the voxels from outside. */
    if (!all(place > -width) || !all(place < side + width))
      break;
    const float4 density = cone_density(voxels, grid, place, width, view);
    if (density.w > 0.0f) {
      const float left = exp(-CONE_DEPTH * density.w * step);
      seen += clear * (1.0f - left) / density.w * density.xyz;
      clear *= left;
    }
    t += step;
  }
  return (float4)(seen, 1.0f - clear);
}

/* Irradiance [W/m2] of a surface by a receiver's cones; each stands for the same share of the light. */
static inline float3 cone_irradiance(const __global float4* voxels, __constant ConeGrid* grid, __constant Cone* cones,
                                     float3 position, float3 normal) {
  const float3 at =
      fma((float3)(CONE_LIFT), normal, (position - load3_constant(grid->origin)) / grid->voxel);
  float3 a, b, sum = (float3)(0.0f);
  tangents(normal, &a, &b);
  for (uint k = 0u; k < grid->cone_count; ++k) {
    const float3 axis = load3_constant(cones[k].axis);
    sum += trace_cone(voxels, grid, at, axis.x * a + axis.y * b + axis.z * normal, cones[k].spread, CONE_LIFT, axis.z).xyz;
  }
  return sum / (float)grid->cone_count;
}
