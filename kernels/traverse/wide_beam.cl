/* Sixteen rays that leave neighbouring surfaces in about the same direction, a beam, through the wide form at once: for
 * devices whose work-items have vector registers of their own. A node's boxes and a block's splats are tested against the
 * beam's bounds; a splat inside them against the rays' distances from its centre; one that some ray may meet against all
 * rays. Answers are bit-identical to those of trace_closest_from. Discs only, no patches. */
#include "traverse/traversal.cl"

/* A beam with a ray farther off its middle than this, or that reaches more splats, gains nothing: in a room beams reach
 * 220 splats on average, and single rays take as long as a beam of some 450. */
#ifndef BEAM_COSINE
#define BEAM_COSINE 0.95f
#endif
#ifndef BEAM_SPLATS
#define BEAM_SPLATS 512u
#endif

/* What bounds are known by, root cube units: several roundings of coordinates below 2. */
#define BEAM_MARGIN 2e-6f

typedef struct Beam {
  float16 ox, oy, oz, dx, dy, dz; /* origins, unit directions */
  float16 nx, ny, nz, radius;     /* of the surface at each origin */
  float16 t_min, t_max;           /* t_min <= 0; t_max INFINITY, or -INFINITY: the ray meets nothing */
} Beam;

typedef struct BeamHits {
  float16 t;
  uint16 splat; /* or NO_SPLAT */
} BeamHits;

/* In a frame of unit vectors: ray i runs at u = u_at[i] + u_slope[i] a, v likewise, where a = along . x. */
typedef struct BeamBounds {
  float3 along, u, v;
  float16 cosine, start; /* of the directions with `along`; a of the origins */
  float16 u_at, u_slope, v_at, v_slope;
  float3 side[4]; /* side . x <= offset holds of all that a ray passes */
  float offset[4], side_length[4];
  float low[2], high[2]; /* slopes: side 0 is u - high[0] a, side 1 low[0] a - u, sides 2 and 3 the same of v */
  float near;            /* a of all that a ray passes is greater */
  float own_end;         /* at and behind it no disc of radius 0 belongs to an origin */
  float stretch;         /* most that a disc's radius seems when it is looked at along a ray, across `along` */
  uint octant;
} BeamBounds;

static inline float smallest16(float16 v) { return smallest8(min(v.lo, v.hi)); }
static inline float largest16(float16 v) { return -smallest16(-v); }

/* One instruction where the compiler knows reductions. */
#ifdef __has_builtin
#if __has_builtin(__builtin_reduce_or)
#define ANY16(v) (__builtin_reduce_or(v) != 0)
#endif
#endif
#ifndef ANY16
#define ANY16(v) (byte_a_lane((v).lo | (v).hi) != 0ul)
#endif
static inline bool any16(int16 v) { return ANY16(v); }

/* dot3 in sixteen lanes. */
static inline float16 dot16(float16 x, float16 y, float16 z, float3 v) {
  return fma(x, (float16)(v.x), fma(y, (float16)(v.y), z * v.z));
}

/* The two sides across an axis, and where the rays run on it. */
static inline void bound_axis(const Beam* beam, int k, float3 axis, BeamBounds* b, float16* at, float16* slope) {
  const float16 origin = dot16(beam->ox, beam->oy, beam->oz, axis);
  *slope = dot16(beam->dx, beam->dy, beam->dz, axis) / b->cosine;
  *at = fma(-b->start, *slope, origin);
  const float low = smallest16(*slope) - 1e-6f, high = largest16(*slope) + 1e-6f;
  /* What lies behind an origin, by SEGMENT_MARGIN at most, is outside by that times a slope. */
  b->side[2 * k] = axis - high * b->along;
  b->offset[2 * k] = largest16(origin - b->start * high) + BEAM_MARGIN + MOST_SEGMENT_MARGIN;
  b->side[2 * k + 1] = low * b->along - axis;
  b->offset[2 * k + 1] = BEAM_MARGIN + MOST_SEGMENT_MARGIN - smallest16(origin - b->start * low);
  b->side_length[2 * k] = sqrt(1.0f + high * high);
  b->side_length[2 * k + 1] = sqrt(1.0f + low * low);
  b->low[k] = low, b->high[k] = high;
}

/* False where the rays do not run close together, with which *b is of no use. */
static inline bool bound_beam(const Beam* beam, BeamBounds* b) {
  const float3 middle = (float3)(smallest16(beam->dx) + largest16(beam->dx), smallest16(beam->dy) + largest16(beam->dy),
                                 smallest16(beam->dz) + largest16(beam->dz));
  const float length2 = dot3(middle, middle);
  if (!(length2 > 1e-6f))
    return false;
  b->along = middle / sqrt(length2);
  b->cosine = dot16(beam->dx, beam->dy, beam->dz, b->along);
  const float least = smallest16(b->cosine);
  if (!(least > BEAM_COSINE))
    return false;
  b->octant = (b->along.x < 0.0f ? 1u : 0u) | (b->along.y < 0.0f ? 2u : 0u) | (b->along.z < 0.0f ? 4u : 0u);
  b->stretch = 1.0f / least;
  b->start = dot16(beam->ox, beam->oy, beam->oz, b->along);
  b->near = smallest16(b->start + beam->t_min) - BEAM_MARGIN;
  b->own_end = largest16(fma((float16)(SELF_HIT_REACH), beam->radius, b->start)) + MOST_COINCIDENT;
  tangents(b->along, &b->u, &b->v);
  bound_axis(beam, 0, b->u, b, &b->u_at, &b->u_slope);
  bound_axis(beam, 1, b->v, b, &b->v_at, &b->v_slope);
  return true;
}

/* Least of v . x in each of the node's boxes. */
static inline float8 least_in_boxes(const __global WideNode* node, float3 v) {
  return fma(vload8(0, v.x > 0.0f ? node->low[0] : node->high[0]), (float8)(v.x),
             fma(vload8(0, v.y > 0.0f ? node->low[1] : node->high[1]), (float8)(v.y),
                 vload8(0, v.z > 0.0f ? node->low[2] : node->high[2]) * v.z));
}

/* children_met for the beam: a child is met when some ray may meet it. *enter: the least a of its box. */
static inline ulong children_met_by_beam(const __global WideNode* node, const BeamBounds* b, float far, float8* enter) {
  *enter = least_in_boxes(node, b->along);
  int8 met = (*enter <= far) & (least_in_boxes(node, -b->along) <= -b->near);
  for (int k = 0; k < 4; ++k)
    met &= least_in_boxes(node, b->side[k]) <= b->offset[k];
  return mirrored(byte_a_lane(met), b->octant);
}

/* Centres of a block's splats in the beam's frame. */
typedef struct BeamBlock {
  float a[WIDE_LANES], u[WIDE_LANES], v[WIDE_LANES];
} BeamBlock;

/* Splats whose ball reaches into the beam before `far`. */
static inline lanes_i splats_in_beam(const __global float* block, const BeamBounds* b, float far, BeamBlock* centres) {
  const lanes_f radius = load_lanes(block + WIDE_RADIUS(WIDE_LANES));
  const lanes_f x = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 0)), y = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 1));
  const lanes_f z = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 2));
  const lanes_f a = fma(x, (lanes_f)(b->along.x), fma(y, (lanes_f)(b->along.y), z * b->along.z));
  const lanes_f u = fma(x, (lanes_f)(b->u.x), fma(y, (lanes_f)(b->u.y), z * b->u.z));
  const lanes_f v = fma(x, (lanes_f)(b->v.x), fma(y, (lanes_f)(b->v.y), z * b->v.z));
  store_lanes(a, centres->a);
  store_lanes(u, centres->u);
  store_lanes(v, centres->v);
  return (radius > 0.0f) & (a + radius >= b->near) & (a - radius <= far) &
         (fma(a, (lanes_f)(-b->high[0]), u) <= fma(radius, (lanes_f)(b->side_length[0]), (lanes_f)(b->offset[0]))) &
         (fma(a, (lanes_f)(b->low[0]), -u) <= fma(radius, (lanes_f)(b->side_length[1]), (lanes_f)(b->offset[1]))) &
         (fma(a, (lanes_f)(-b->high[1]), v) <= fma(radius, (lanes_f)(b->side_length[2]), (lanes_f)(b->offset[2]))) &
         (fma(a, (lanes_f)(b->low[1]), -v) <= fma(radius, (lanes_f)(b->side_length[3]), (lanes_f)(b->offset[3])));
}

/* Whether some ray passes the splat's centre, in the plane across `along` there, by no more than its disc may seem. */
static inline bool some_ray_near(const BeamBounds* b, const BeamBlock* centres, uint lane, float radius) {
  const float16 u = fma((float16)(centres->a[lane]), b->u_slope, b->u_at - centres->u[lane]);
  const float16 v = fma((float16)(centres->a[lane]), b->v_slope, b->v_at - centres->v[lane]);
  const float reach = fma(radius, b->stretch, BEAM_MARGIN);
  return any16(fma(u, u, v * v) <= reach * reach);
}

/* A splat as the beam meets it. */
typedef struct BeamSplat {
  float3 centre, normal;
  float radius;
  uint index;
  bool sheet, flat; /* `flat` counts only where HAS_CLIPS */
  const __global float* clip; /* or null */
} BeamSplat;

static inline BeamSplat splat_of_block(const __global float* blocks, const __global float* block, uint lane) {
  BeamSplat s;
  s.centre = (float3)(block[WIDE_CENTRE(WIDE_LANES, 0) + lane], block[WIDE_CENTRE(WIDE_LANES, 1) + lane],
                      block[WIDE_CENTRE(WIDE_LANES, 2) + lane]);
  s.normal = (float3)(block[WIDE_NORMAL(WIDE_LANES, 0) + lane], block[WIDE_NORMAL(WIDE_LANES, 1) + lane],
                      block[WIDE_NORMAL(WIDE_LANES, 2) + lane]);
  s.radius = block[WIDE_RADIUS(WIDE_LANES) + lane];
  s.index = as_uint(block[WIDE_FIRST(WIDE_LANES)]) + lane;
  s.sheet = (as_uint(block[WIDE_SHEETS(WIDE_LANES)]) >> lane & 1u) != 0u;
  s.flat = false;
  s.clip = 0;
#ifdef HAS_CLIPS
  s.flat = (as_uint(block[WIDE_FLAT(WIDE_LANES)]) >> lane & 1u) != 0u;
  const uint clipped = as_uint(block[WIDE_CLIPPED(WIDE_LANES)]), bit = 1u << lane;
  if (clipped & bit)
    s.clip = blocks + as_uint(block[WIDE_CLIPS(WIDE_LANES)]) + CLIP_WORDS * popcount(clipped & (bit - 1u));
#endif
  return s;
}

/* belongs_to_origin of one disc for each ray, met at t. own_along: cosines of the disc's normal with the rays. */
static inline int16 rays_of_origin(const Beam* beam, float16 t, float16 own_along, const BeamSplat* s) {
  float16 cosine = fma((float16)(s->normal.x), beam->nx, fma((float16)(s->normal.y), beam->ny, s->normal.z * beam->nz));
  float16 along = own_along;
  const float16 radii = beam->radius + s->radius, height = t * fabs(own_along);
  const int16 apart = s->flat ? height > FLAT_HEIGHT : (int16)(0);
  if (s->sheet) {
    const int16 turned = (cosine < 0.0f) & (height < SHEET_HEIGHT * radii) & ~apart;
    cosine = select(cosine, -cosine, turned);
    along = select(along, -along, turned);
  }
  /* steepness_at_end and COINCIDENT in lanes */
  const float16 steepness = max((float16)(1.0f), SELF_HIT_REACH / SELF_HIT_HEIGHT *
                                                     fabs(fma(beam->nx, beam->dx, fma(beam->ny, beam->dy, beam->nz * beam->dz))));
  const float16 coincident = clamp(0.01f * radii, ROUNDING_OF_HITS, MOST_COINCIDENT);
  return (((steepness * t < SELF_HIT_REACH * radii) & (cosine > SELF_HIT_COSINE)) |
          ((t < coincident) & (cosine < -SELF_HIT_COSINE))) &
         ~apart & ~((along < 0.0f) & (t > ARRIVAL_DISTANCE * s->radius));
}

/* meet of one disc for each ray; keeps the hits that are nearer. may_be_own: it may belong to some origin. */
static inline void hit_beam(const Beam* beam, const BeamSplat* s, bool may_be_own, BeamHits* best) {
  const float3 normal = s->normal;
  const float16 cx = s->centre.x - beam->ox, cy = s->centre.y - beam->oy, cz = s->centre.z - beam->oz;
  const float16 along = fma((float16)(normal.x), beam->dx, fma((float16)(normal.y), beam->dy, normal.z * beam->dz));
  const float16 t = fma((float16)(normal.x), cx, fma((float16)(normal.y), cy, normal.z * cz)) / along;
  const float16 x = fma(t, beam->dx, -cx), y = fma(t, beam->dy, -cy), z = fma(t, beam->dz, -cz);
  int16 nearer = (fma(x, x, fma(y, y, z * z)) <= s->radius * s->radius) & (t > beam->t_min) &
                 ((t < best->t) | ((t == best->t) & as_int16((uint16)(s->index) < best->splat)));
  if (may_be_own) {
    if (!any16(nearer))
      return;
    nearer &= ~rays_of_origin(beam, t, along, s);
  }
#ifdef HAS_CLIPS
  if (s->clip != 0)
    for (int k = 0; k < CLIP_STRIPS; ++k) {
      const __global float* strip = s->clip + k * STRIP_WORDS;
      const float16 at = dot16(x, y, z, STRIP_AXIS(strip));
      nearer &= ~((at < STRIP_LOW(strip)) | (at > STRIP_HIGH(strip)));
    }
#endif
  best->t = select(best->t, t, nearer);
  best->splat = select(best->splat, (uint16)(s->index), nearer);
}

/* The splats of a block that rays may meet; returns how many lie in the beam. */
static inline uint hit_block_by_beam(const __global float* blocks, const __global float* block, const Beam* beam,
                                     const BeamBounds* b, float far, BeamHits* best) {
  BeamBlock centres;
  int in_beam[WIDE_LANES];
  store_lanes(splats_in_beam(block, b, far, &centres), in_beam);
  uint count = 0u;
  for (int part = 0; part < WIDE_LANES / 8; ++part) {
    const ulong inside = byte_a_lane(vload8(part, in_beam));
    ulong near_ray = 0ul;
    for (ulong left = inside; left != 0ul; left &= left - 1ul) { /* without a branch, which could not be predicted */
      const uint lane = 8u * part + lowest_byte(left);
      near_ray |= some_ray_near(b, &centres, lane, block[WIDE_RADIUS(WIDE_LANES) + lane]) ? left & (0ul - left) : 0ul;
    }
    count += (uint)popcount(inside);
    for (ulong left = near_ray; left != 0ul; left &= left - 1ul) {
      const uint lane = 8u * part + lowest_byte(left);
      const BeamSplat s = splat_of_block(blocks, block, lane);
      /* SELF_HIT_REACH radii of it from the hit, which is one off its centre */
      hit_beam(beam, &s, centres.a[lane] - (SELF_HIT_REACH + 1.0f) * s.radius < b->own_end, best);
    }
  }
  return count;
}

/* Nearest hits of all rays; false where so many splats are reached that single rays are faster, and *best is of no use. */
static inline bool trace_beam(POOL_PARAMS, const Beam* beam, const BeamBounds* b, BeamHits* best) {
  best->t = beam->t_max;
  best->splat = (uint16)(NO_SPLAT);
  float far = INFINITY; /* a of the farthest hit */
  uint splats = 0u;
  WALK_FROM_ROOT(walk); /* its t_enter: a */
  while (walk.count > 0) {
    walk.count -= 1;
    if (walk.t_enter[walk.count] > far)
      continue;
    const uint current = walk.waiting[walk.count];
    if (!(current & WIDE_LEAF)) {
      float8 enter;
      const ulong met = children_met_by_beam(node_pool + current, b, far, &enter);
      push_children(&walk, node_pool + current, met, enter, b->octant);
      continue;
    }
    FOR_BLOCKS_OF_LEAF(current, block, { splats += hit_block_by_beam(block_pool, block, beam, b, far, best); })
    if (splats > BEAM_SPLATS)
      return false;
    far = largest16(fma(best->t, b->cosine, b->start)) + BEAM_MARGIN;
  }
  return true;
}
