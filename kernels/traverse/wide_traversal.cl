/* The wide form of the octree: one ray against eight child boxes and WIDE_LANES splats at a time, near children first.
 * Written in vectors of the language, because CPU compilers do not vectorise diverging work-items; for devices whose
 * work-items have vector registers of their own.
 * What every form gives: trace_closest, trace_closest_from, trace_any, blend_others (kernels/traverse/traversal.cl). */
#include "lib/lanes.cl"
#include "lib/pools.cl"
#include "surface/surface.cl"
#include "surface/disc_lanes.cl"
#include "surface/own_surface_lanes.cl"

/* A ray as the box tests take it. */
typedef struct WideRay {
  float3 inverse, shift; /* t of the plane x is fma(x, inverse.x, shift.x) */
  uint octant;           /* bit a: the ray runs downwards on axis a */
} WideRay;

static inline WideRay wide_ray(Ray ray) {
  WideRay w;
  /* Never zero: 1e-18 moves a ray by nothing, and its inverse squared stays finite. */
  const float3 d = select(ray.direction, copysign((float3)(1e-18f), ray.direction), fabs(ray.direction) < 1e-18f);
  w.inverse = 1.0f / d;
  w.shift = -ray.origin * w.inverse;
  if (!is_finite_ray(ray)) { /* such that it meets no box */
    w.inverse = (float3)(0.0f);
    w.shift = (float3)(INFINITY, -INFINITY, 0.0f);
  }
  w.octant = (d.x < 0.0f ? 1u : 0u) | (d.y < 0.0f ? 2u : 0u) | (d.z < 0.0f ? 4u : 0u);
  return w;
}

/* A byte a child, in child order, into the ray's order: child c goes to byte 7 - (c ^ octant), so that the nearest
 * octant comes to stand highest. Reversing all bytes is an exchange on each of the three axes. */
static inline ulong mirrored(ulong met, uint octant) {
  if (!(octant & 1u))
    met = ((met & 0x00ff00ff00ff00fful) << 8) | ((met >> 8) & 0x00ff00ff00ff00fful);
  if (!(octant & 2u))
    met = ((met & 0x0000ffff0000fffful) << 16) | ((met >> 16) & 0x0000ffff0000fffful);
  if (!(octant & 4u))
    met = (met << 32) | (met >> 32);
  return met;
}

/* Children whose boxes the ray meets in [t_from, t_to]: a byte a child, in the ray's order, nearest octant in the
 * highest byte; *t_enter by child number. */
static inline ulong children_met(const __global WideNode* node, WideRay ray, float t_from, float t_to, float8* t_enter) {
  const bool dx = (ray.octant & 1u) != 0u, dy = (ray.octant & 2u) != 0u, dz = (ray.octant & 4u) != 0u;
  const float8 near_x = fma(vload8(0, dx ? node->high[0] : node->low[0]), (float8)(ray.inverse.x), (float8)(ray.shift.x));
  const float8 far_x = fma(vload8(0, dx ? node->low[0] : node->high[0]), (float8)(ray.inverse.x), (float8)(ray.shift.x));
  const float8 near_y = fma(vload8(0, dy ? node->high[1] : node->low[1]), (float8)(ray.inverse.y), (float8)(ray.shift.y));
  const float8 far_y = fma(vload8(0, dy ? node->low[1] : node->high[1]), (float8)(ray.inverse.y), (float8)(ray.shift.y));
  const float8 near_z = fma(vload8(0, dz ? node->high[2] : node->low[2]), (float8)(ray.inverse.z), (float8)(ray.shift.z));
  const float8 far_z = fma(vload8(0, dz ? node->low[2] : node->high[2]), (float8)(ray.inverse.z), (float8)(ray.shift.z));
  const float8 t0 = max(max(near_x, near_y), max(near_z, (float8)(t_from)));
  const float8 t1 = min(min(far_x, far_y), min(far_z, (float8)(t_to)));
  *t_enter = t0;
  return mirrored(byte_a_lane(t0 <= t1), ray.octant);
}

/* Nodes and leaves that wait, with the t at which the ray enters them. The arrays stand apart, so that the count is kept
 * in a register. */
typedef struct WideWalk {
  uint* waiting;
  float* t_enter;
  int count;
} WideWalk;

/* Declares the walk `name`, in which the root waits. */
#define WALK_FROM_ROOT(name)         \
  uint name##_waiting[WIDE_STACK];   \
  float name##_t_enter[WIDE_STACK];  \
  name##_waiting[0] = 0u;            \
  name##_t_enter[0] = -INFINITY;     \
  WideWalk name = {name##_waiting, name##_t_enter, 1}

/* Puts the children met (in the ray's order) to wait, farthest first, so that the nearest is taken next. */
static inline void push_children(WideWalk* walk, const __global WideNode* node, ulong met, float8 t_enter, uint octant) {
  float t_of[8];
  vstore8(t_enter, 0, t_of);
  while (met != 0ul) {
    const uint child = (7u - lowest_byte(met)) ^ octant;
    met &= met - 1ul;
    walk->waiting[walk->count] = node->child[child];
    walk->t_enter[walk->count] = t_of[child];
    walk->count += 1;
  }
}

/* The next leaf, near ones first, whose box is met in [t_from, t_to]; 0 when none is left. t_to may shrink from call to
 * call. */
static inline uint next_leaf(const __global WideNode* nodes, WideRay ray, WideWalk* walk, float t_from, float t_to) {
  while (walk->count > 0) {
    walk->count -= 1;
    if (walk->t_enter[walk->count] > t_to)
      continue;
    const uint current = walk->waiting[walk->count];
    if (current & WIDE_LEAF)
      return current;
    const __global WideNode* node = nodes + current;
    float8 t_enter;
    const ulong met = children_met(node, ray, t_from, t_to, &t_enter);
    push_children(walk, node, met, t_enter, ray.octant);
  }
  return 0u;
}

#define FOR_BLOCKS_OF_LEAF(leaf, block, body)                                              \
  {                                                                                        \
    const uint block_count_ = ((leaf) & ~WIDE_LEAF) >> 24;                                 \
    const __global float* block = block_pool + (size_t)((leaf) & WIDE_BLOCK_MASK) * WIDE_BLOCK_WORDS(WIDE_LANES); \
    for (uint b_ = 0u; b_ < block_count_; ++b_, block += WIDE_BLOCK_WORDS(WIDE_LANES))     \
      body                                                                                 \
  }

/* Nearest hit in (ray.t_min, ray.t_max); of splats hit at the same t the one with the lowest index. */
static inline Hit trace_closest(POOL_PARAMS, Ray ray) {
  Hit best = {ray.t_max, NO_SPLAT};
  const WideRay wide = wide_ray(ray);
  WALK_FROM_ROOT(walk);
  for (uint leaf; (leaf = next_leaf(node_pool, wide, &walk, ray.t_min, best.t)) != 0u;) {
    FOR_BLOCKS_OF_LEAF(leaf, block, {
      FOR_HITS_OF_BLOCK(block, ray, h, {
        const lanes_u index = h.first + LANE_NUMBERS;
        const lanes_i met = h.inside & (h.t > ray.t_min) &
                            ((h.t < best.t) | ((h.t == best.t) & (as_lanes_i(index < best.splat))))
                            AND_SIDE_COUNTS(cosines_of_lanes(&h, ray.direction));
        const lanes_i nearer = UNCLIPPED_LANES(block, ray, h, met);
        if (any_lane(nearer)) {
          const lanes_f t = select((lanes_f)(INFINITY), h.t, nearer);
          best.t = smallest_lane(t);
          best.splat = smallest_lane_u(select((lanes_u)(NO_SPLAT), index, nearer & (t == best.t)));
        }
      })
    })
  }
  return best;
}

/* trace_closest of a ray that leaves a surface: what belongs to that does not count (belongs_to_origin). */
static inline Hit trace_closest_from(POOL_PARAMS, Ray ray, OcclusionEnds ends) {
  Hit best = {ray.t_max, NO_SPLAT};
  const WideRay wide = wide_ray(ray);
  WALK_FROM_ROOT(walk);
  for (uint leaf; (leaf = next_leaf(node_pool, wide, &walk, ray.t_min, best.t)) != 0u;) {
    FOR_BLOCKS_OF_LEAF(leaf, block, {
      FOR_HITS_OF_BLOCK(block, ray, h, {
        const lanes_u index = h.first + LANE_NUMBERS;
        const lanes_i met = h.inside & (h.t > ray.t_min) &
                            ((h.t < best.t) | ((h.t == best.t) & (as_lanes_i(index < best.splat))));
        if (any_lane(met)) {
          const lanes_i nearer = UNCLIPPED_LANES(block, ray, h, met & ~LANES_OF_ORIGIN(&h, met));
          if (any_lane(nearer)) {
            const lanes_f t = select((lanes_f)(INFINITY), h.t, nearer);
            best.t = smallest_lane(t);
            best.splat = smallest_lane_u(select((lanes_u)(NO_SPLAT), index, nearer & (t == best.t)));
          }
        }
      })
    })
  }
  return best;
}

/* Whether anything but the surfaces at the ray's two ends is hit in (ray.t_min, ray.t_max). */
static inline bool trace_any(POOL_PARAMS, Ray ray, OcclusionEnds ends) {
  const WideRay wide = wide_ray(ray);
  const float at_origin = steepness_at_end(ends.origin_normal, ray.direction);
  const float at_target = steepness_at_end(ends.target_normal, ray.direction);
  WALK_FROM_ROOT(walk);
  for (uint leaf; (leaf = next_leaf(node_pool, wide, &walk, ray.t_min, ray.t_max)) != 0u;) {
    FOR_BLOCKS_OF_LEAF(leaf, block, {
      FOR_HITS_OF_BLOCK(block, ray, h, {
        const lanes_i hit = h.inside & (h.t > ray.t_min) & (h.t < ray.t_max);
        if (any_lane(hit)) {
          const lanes_i blocking =
              hit & ~discs_of_end(ends.origin_normal, ends.origin_radius, at_origin, ray.direction, h.t, &h) &
              ~discs_of_end(ends.target_normal, ends.target_radius, at_target, -ray.direction, ray.t_max - h.t, &h);
          if (any_lane(UNCLIPPED_LANES(block, ray, h, blocking)))
            return true;
        }
      })
    })
  }
  return false;
}

/* Adds all splats but the first that are hit in the blend's window. */
static inline void blend_others(POOL_PARAMS, Ray ray, Blend* blend) {
  const WideRay wide = wide_ray(ray);
  WALK_FROM_ROOT(walk);
  for (uint leaf; (leaf = next_leaf(node_pool, wide, &walk, BLEND_BEGIN(blend), blend->t_end)) != 0u;) {
    FOR_BLOCKS_OF_LEAF(leaf, block, {
      FOR_HITS_OF_BLOCK(block, ray, h, {
        const lanes_i met = h.inside & (h.t >= BLEND_BEGIN(blend)) & (h.t < blend->t_end) &
                            as_lanes_i((h.first + LANE_NUMBERS) != blend->splat);
        lanes_i counts = met;
#ifdef HAS_CLIPS
        const lanes_i unclipped = UNCLIPPED_LANES(block, ray, h, met);
        counts = (unclipped & (h.t >= blend->t_first)) | (met & ~unclipped & ~flat_lanes(&h));
#endif
        if (any_lane(counts)) {
          float t_of[WIDE_LANES];
          float q_of[WIDE_LANES];
          store_lanes(select((lanes_f)(-INFINITY), h.t, counts), t_of);
          store_lanes(h.q, q_of);
          KEEP_NORMALS(&h, normal_of);
          for (uint lane = 0u; lane < WIDE_LANES; ++lane)
            if (t_of[lane] > -INFINITY) {
              const uint i = h.first + lane;
              Meeting m;
              m.t = t_of[lane];
              m.q = q_of[lane];
              m.normal = KEPT_NORMAL(normal_of, lane, i);
              blend_add(POOL_ARGS, blend, ray, i, m, pool_point_texel(POINT_TEXELS * i + 2u).xyz);
            }
        }
      })
    })
  }
}
