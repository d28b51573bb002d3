/* Octree stepping, the thesis' traversal (method.md section 6): find the leaf that holds the ray's position, test its
 * splats, own and extra, else go on to the leaf behind the exit plane.
 *   default            exact stepping: the position is an integer cell of the finest level, and the neighbour behind the
 *                      exit plane follows without rounding, so the ray moves on at every scale
 *   STEP_ABSOLUTE      the thesis' way: the position moves past the exit plane by an absolute delta and is located anew;
 *                      thin cells are jumped over when delta is large, and the ray may stall when it is small
 * What every form gives: trace_closest, trace_closest_from, trace_any, blend_others (kernels/traverse/traversal.cl). */
#include "traverse/octree_descent.cl"
#include "surface/surface.cl"

#define FINEST_CELLS (1 << MAX_AXIS_BITS)
#define FINEST_SIDE 0x1p-21f /* 1 / FINEST_CELLS */

/* Where a walk stands: the leaf, and the part of the ray inside it. */
typedef struct Walk {
  float3 origin, direction, inverse;
  int3 position; /* finest cell */
  int3 forward;  /* per axis: the ray runs upwards */
  uint4 node;
  int3 low, high; /* finest cells of the leaf's cell: [low, high) */
  float3 t_plane; /* where the ray leaves the cell on each axis; infinity on one it runs along */
  float t_exit;   /* the nearest of these */
#ifdef STEP_ABSOLUTE
  float delta;
  float3 point;
  uint steps_left;
#endif
} Walk;

static inline int3 finest_cell(float3 p) {
  return clamp(convert_int3(p * (float)FINEST_CELLS), (int3)(0), (int3)(FINEST_CELLS - 1));
}

/* Reads the leaf at the walk's position and the ray's exit from its cell. */
static inline void walk_enter(POOL_PARAMS, Walk* w) {
  w->node = octree_descend(POOL_ARGS, convert_float3(w->position) * FINEST_SIDE);
  const int side = 1 << (MAX_AXIS_BITS - (int)NODE_LEVEL(w->node.x) * OCTREE_AXIS_BITS);
  w->low = w->position & (int3)(-side);
  w->high = w->low + side;
  const float3 plane = convert_float3(select(w->low, w->high, w->forward)) * FINEST_SIDE;
  /* An axis the ray runs along exactly has an infinite inverse: 0 * inf must not become NaN. */
  w->t_plane = select((plane - w->origin) * w->inverse, (float3)(INFINITY), isinf(w->inverse));
  w->t_exit = fmin(w->t_plane.x, fmin(w->t_plane.y, w->t_plane.z));
}

/* Starts at parameter t, where the ray is inside the root cube. */
static inline void walk_start(POOL_PARAMS, Walk* w, Ray ray, float t) {
  w->origin = ray.origin;
  w->direction = ray.direction;
  /* Below 1e-18 a component moves the ray by less than a finest cell over any distance in the cube. */
  w->inverse = select(1.0f / ray.direction, (float3)(INFINITY), fabs(ray.direction) < 1e-18f);
  w->forward = ray.direction > 0.0f;
  const float3 start = fma((float3)(t), ray.direction, ray.origin);
  w->position = finest_cell(start);
#ifdef STEP_ABSOLUTE
  w->delta = ray.step_delta;
  w->point = start;
  w->steps_left = 65536u;
#endif
  walk_enter(POOL_ARGS, w);
}

/* Goes on to the next leaf; false when the ray leaves the root cube. */
static inline bool walk_next(POOL_PARAMS, Walk* w) {
#ifdef STEP_ABSOLUTE
  w->point = fma((float3)(w->t_exit + w->delta), w->direction, w->origin);
  if (any(w->point < 0.0f) || any(w->point >= 1.0f) || --w->steps_left == 0u)
    return false;
  w->position = finest_cell(w->point);
#else
  /* Inside the cell on the axes that are not crossed, whatever rounding says: a plane once crossed stays crossed. */
  const int3 at = convert_int3_sat(fma((float3)(w->t_exit), w->direction, w->origin) * (float)FINEST_CELLS);
  const int3 behind = select(w->low - 1, w->high, w->forward);
  w->position = select(clamp(at, w->low, w->high - 1), behind, w->t_plane <= w->t_exit);
  if (any(w->position < 0) || any(w->position >= FINEST_CELLS))
    return false;
#endif
  walk_enter(POOL_ARGS, w);
  return true;
}

/* Runs `body` for each splat of the walk's leaf, own points first, with `index` its place in the point pool. */
#define FOR_SPLATS_OF_LEAF(node, index, body)                                        \
  if (NODE_TYPE((node).x) == NODE_LEAF) {                                            \
    const uint own_begin = pool_begin_end((node).y);                                 \
    const uint own_count = (node).w, all_count = (node).w + (node).z;                \
    for (uint k_ = 0u; k_ < all_count; ++k_) {                                       \
      const uint index = k_ < own_count ? own_begin + k_                             \
                                        : pool_begin_end((node).y + 1u + k_ - own_count); \
      body                                                                           \
    }                                                                                \
  }

/* Whether splat i, which the ray meets at t, is clipped off there. */
#ifdef HAS_CLIPS
static inline bool is_cut(POOL_PARAMS, uint i, Ray ray, float t, float3 centre) {
  const uint at = pool_begin_end(i);
  if (at == 0u)
    return false;
  const float3 off = fma((float3)(t), ray.direction, ray.origin - centre);
  bool outside = false;
  for (uint k = 0u; k < CLIP_STRIPS; ++k) {
    const uint word = at + STRIP_WORDS * k;
    const float3 axis = (float3)(as_float(pool_begin_end(word)), as_float(pool_begin_end(word + 1u)),
                                 as_float(pool_begin_end(word + 2u)));
    const float s = dot3(axis, off);
    outside = outside || s < as_float(pool_begin_end(word + 3u)) || s > as_float(pool_begin_end(word + 4u));
  }
  return outside;
}
#define IS_CUT(i, ray, t, centre) is_cut(POOL_ARGS, i, ray, t, (centre).xyz)
#else
#define IS_CUT(i, ray, t, centre) false
#endif

/* Nearest hit in (ray.t_min, ray.t_max); of splats hit at the same t the one with the lowest index. */
static inline Hit trace_closest(POOL_PARAMS, Ray ray) {
  Hit best = {ray.t_max, NO_SPLAT};
  float t_enter, t_leave;
  if (!ray_meets_root(ray, &t_enter, &t_leave))
    return best;
  Walk walk;
  walk_start(POOL_ARGS, &walk, ray, t_enter);
  do {
    FOR_SPLATS_OF_LEAF(walk.node, i, {
      const float4 centre = pool_point_texel(POINT_TEXELS * i);
      FOR_MEETINGS(m, ray.origin, ray.direction, centre, pool_point_texel(POINT_TEXELS * i + 1u), pool_bend(i), {
        if (m.t > ray.t_min && (m.t < best.t || (m.t == best.t && i < best.splat)) &&
            SIDE_COUNTS(dot3(m.normal.xyz, ray.direction)) && !IS_CUT(i, ray, m.t, centre)) {
          best.t = m.t;
          best.splat = i;
        }
      })
    })
  } while (walk.t_exit < best.t && walk_next(POOL_ARGS, &walk));
  return best;
}

/* trace_closest of a ray that leaves a surface: what belongs to that does not count (belongs_to_origin). */
static inline Hit trace_closest_from(POOL_PARAMS, Ray ray, OcclusionEnds ends) {
  Hit best = {ray.t_max, NO_SPLAT};
  float t_enter, t_leave;
  if (!ray_meets_root(ray, &t_enter, &t_leave))
    return best;
  Walk walk;
  walk_start(POOL_ARGS, &walk, ray, t_enter);
  do {
    FOR_SPLATS_OF_LEAF(walk.node, i, {
      const float4 centre = pool_point_texel(POINT_TEXELS * i);
      FOR_MEETINGS(m, ray.origin, ray.direction, centre, pool_point_texel(POINT_TEXELS * i + 1u), pool_bend(i), {
        if (m.t > ray.t_min && (m.t < best.t || (m.t == best.t && i < best.splat)) &&
            !belongs_to_origin(ends, ray.direction, m.t, centre.w, m.normal) && !IS_CUT(i, ray, m.t, centre)) {
          best.t = m.t;
          best.splat = i;
        }
      })
    })
  } while (walk.t_exit < best.t && walk_next(POOL_ARGS, &walk));
  return best;
}

/* Whether anything but the surfaces at the ray's two ends is hit in (ray.t_min, ray.t_max). */
static inline bool trace_any(POOL_PARAMS, Ray ray, OcclusionEnds ends) {
  float t_enter, t_leave;
  if (!ray_meets_root(ray, &t_enter, &t_leave))
    return false;
  Walk walk;
  walk_start(POOL_ARGS, &walk, ray, t_enter);
  do {
    FOR_SPLATS_OF_LEAF(walk.node, i, {
      const float4 centre = pool_point_texel(POINT_TEXELS * i);
      FOR_MEETINGS(m, ray.origin, ray.direction, centre, pool_point_texel(POINT_TEXELS * i + 1u), pool_bend(i), {
        if (m.t > ray.t_min && m.t < ray.t_max &&
            !belongs_to_ends(ends, ray.direction, ray.t_max, m.t, centre.w, m.normal) && !IS_CUT(i, ray, m.t, centre))
          return true;
      })
    })
  } while (walk.t_exit < ray.t_max && walk_next(POOL_ARGS, &walk));
  return false;
}

/* Adds all splats but the first that are hit in the blend's window. A splat is listed in every cell that it touches; it
 * counts in the one cell that holds its hit, so it counts once. */
static inline void blend_others(POOL_PARAMS, Ray ray, Blend* blend) {
  Walk walk;
  float t_begin = BLEND_BEGIN(blend);
#ifdef HAS_CLIPS
  float t_enter, t_leave; /* what was clipped off may begin before the root cube does */
  if (ray_meets_root(ray, &t_enter, &t_leave))
    t_begin = fmax(t_begin, t_enter);
#endif
  walk_start(POOL_ARGS, &walk, ray, t_begin);
  float t_from = -INFINITY;
  do {
    FOR_SPLATS_OF_LEAF(walk.node, i, {
      const float4 centre = pool_point_texel(POINT_TEXELS * i);
      FOR_MEETINGS(m, ray.origin, ray.direction, centre, pool_point_texel(POINT_TEXELS * i + 1u), pool_bend(i), {
        if (m.t >= t_from && m.t < walk.t_exit && m.t >= BLEND_BEGIN(blend) && m.t < blend->t_end && i != blend->splat &&
            (IS_CUT(i, ray, m.t, centre) ? !IS_FLAT(m.normal.w) : m.t >= blend->t_first))
          blend_add(POOL_ARGS, blend, ray, i, m, pool_point_texel(POINT_TEXELS * i + 2u).xyz);
      })
    })
    t_from = walk.t_exit;
  } while (walk.t_exit < blend->t_end && walk_next(POOL_ARGS, &walk));
}
