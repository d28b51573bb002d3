/* Which hits of a ray belong to the surfaces at its two ends: discs overlap, and those around an end stick out of the
 * surface that they stand for. kernels/surface/own_surface_lanes.cl says the same of a block of discs. */
#include "lib/vector.cl"
#include "shared/octree_types.h"
#include "shared/traversal_types.h"

typedef struct OcclusionEnds {
  float3 origin_normal, target_normal; /* facing the ray or not: the side does not matter, the splat's own normal does */
  float origin_radius, target_radius;  /* 0: no surface at that end (a point light, the environment) */
#ifdef HAS_SPECULAR
  uint origin_material; /* 1 + material of the surface at the origin: discs of others are no part of it; 0: all may be */
  uint origin_back;     /* 1: the ray goes off on the back side of the surface there, into glass */
  uint origin_through;  /* 1: it came through that surface */
  uint medium;          /* 1 + material of the glass that the ray is in; 0: none */
#endif
} OcclusionEnds;

static inline OcclusionEnds free_ends(void) {
  OcclusionEnds ends = {(float3)(0.0f), (float3)(0.0f), 0.0f, 0.0f};
#ifdef HAS_SPECULAR
  ends.origin_material = ends.origin_back = ends.origin_through = ends.medium = 0u;
#endif
  return ends;
}

/* By how much a steep ray's way from an end counts as longer than it is: it is as far from the surface there as a flat
 * ray is at SELF_HIT_REACH. */
static inline float steepness_at_end(float3 end_normal, float3 direction) {
  return fmax(1.0f, SELF_HIT_REACH / SELF_HIT_HEIGHT * fabs(dot3(end_normal, direction)));
}

/* Whether a disc that is met `distance` from an end of a ray belongs to the surface there. */
static inline bool belongs_to_end(float3 end_normal, float end_radius, float steepness, float distance, float radius,
                                  float3 normal) {
  const float cosine = dot3(normal, end_normal);
  return (steepness * distance < SELF_HIT_REACH * (end_radius + radius) && cosine > SELF_HIT_COSINE) ||
         (distance < COINCIDENT(end_radius + radius) && cosine < -SELF_HIT_COSINE);
}

static inline bool is_sheet(float material) { return SHEET_SIDE(material) != 0.0f; }

/* Whether what is met on a disc lies too far from an end's own plane to belong to it, however near it is: no flat disc sticks
 * out of its surface. normal.w: the disc's material. */
#ifdef HAS_CLIPS
static inline bool is_apart(float3 direction, float distance, float4 normal) {
  return IS_FLAT(normal.w) && distance * fabs(dot3(normal.xyz, direction)) > FLAT_HEIGHT;
}
#else
static inline bool is_apart(float3 direction, float distance, float4 normal) { return false; }
#endif

/* Of a sheet's two sides, which lie in one place, the one that faces as an end does speaks for both, where the end may lie
 * on that sheet (SHEET_HEIGHT): whether that is the other side of the disc that is met `distance` from the end.
 * normal.w: the disc's material. */
static inline bool is_turned(float3 end_normal, float end_radius, float3 direction, float distance, float radius,
                             float4 normal) {
  return is_sheet(normal.w) && dot3(normal.xyz, end_normal) < 0.0f &&
         distance * fabs(dot3(normal.xyz, direction)) < SHEET_HEIGHT * (end_radius + radius) &&
         !is_apart(direction, distance, normal);
}

/* The normal by which such a disc is judged at the end. */
static inline float3 normal_at_end(float3 end_normal, float end_radius, float3 direction, float distance, float radius,
                                   float4 normal) {
  return is_turned(end_normal, end_radius, direction, distance, radius, normal) ? -normal.xyz : normal.xyz;
}

/* Whether a place `distance` off on a disc is the far side of the sheet on which the end lies: discs of a bent sheet stick
 * out of it, and would show the end the side that is turned away from it. */
static inline bool is_own_far_side(float3 end_normal, float end_radius, float3 direction, float distance, float radius,
                                   float4 normal) {
  return is_turned(end_normal, end_radius, direction, distance, radius, normal) &&
         belongs_to_end(end_normal, end_radius, steepness_at_end(end_normal, direction), distance, radius, -normal.xyz);
}

/* belongs_to_end of a disc of the pool, `away` being the ray's direction away from the end. A sheet's disc is met when that
 * way arrives at the side that faces as the end does (ARRIVAL_DISTANCE): what lies behind it is on the other side of the
 * sheet, which may be lit while this one is not. */
static inline bool disc_belongs_to_end(float3 end_normal, float end_radius, float3 away, float distance, float radius,
                                       float4 normal) {
  const float3 n = normal_at_end(end_normal, end_radius, away, distance, radius, normal);
  return belongs_to_end(end_normal, end_radius, steepness_at_end(end_normal, away), distance, radius, n) &&
         !is_apart(away, distance, normal) &&
         !(is_sheet(normal.w) && dot3(n, away) < 0.0f && distance > ARRIVAL_DISTANCE * radius);
}

/* normal.w: the disc's material. A ray that goes off into glass passes by the discs whose fronts it meets near there, and
 * arrives at backs: all that was said of sides is turned round. What is coincident and faces the other way, the far side of
 * a sheet or the floor that glass stands on, does not stop a ray that is thrown back; one that came through must meet it.
 * Of another material that continues the surface in its plane, discs stick over the edge: a ray that is thrown back does
 * not meet their far sides. */
static inline bool belongs_to_origin(OcclusionEnds ends, float3 direction, float t, float radius, float4 normal) {
  normal.xyz = normal_at_end(ends.origin_normal, ends.origin_radius, direction, t, radius, normal);
  float along = dot3(normal.xyz, direction);
#ifdef HAS_SPECULAR
  if (ends.origin_material != 0u) {
    along = ends.origin_back != 0u ? -along : along;
    if (dot3(normal.xyz, ends.origin_normal) < 0.0f) {
      if (ends.origin_through != 0u)
        return false;
    } else if ((uint)normal.w + 1u != ends.origin_material) {
      return ends.origin_through == 0u && along > 0.0f && t < COINCIDENT(ends.origin_radius + radius);
    }
  }
#endif
  return belongs_to_end(ends.origin_normal, ends.origin_radius, steepness_at_end(ends.origin_normal, direction), t, radius,
                        normal.xyz) &&
         !is_apart(direction, t, normal) && !(along < 0.0f && t > ARRIVAL_DISTANCE * radius);
}

static inline bool belongs_to_ends(OcclusionEnds ends, float3 direction, float t_max, float t, float radius,
                                   float4 normal) {
  return disc_belongs_to_end(ends.origin_normal, ends.origin_radius, direction, t, radius, normal) ||
         disc_belongs_to_end(ends.target_normal, ends.target_radius, -direction, t_max - t, radius, normal);
}
