/* The rays of 2 x 2 pixels from one origin through the wide form at once, in vectors of 16: for eye rays, on devices whose
 * work-items have vector registers of their own. A node is tested once for all rays, by bounds of their inverse
 * directions; a block of splats once, against the sides of the frustum around each half of a pixel; a splat meets only
 * those halves whose frustum it reaches into. Answers are bit-identical to those of trace_closest. */
#include "traverse/traversal.cl"

#define PACKET_GROUPS (PACKET_RAYS / 16) /* half pixels, each a vector of rays */
#define GROUP_COLUMNS PACKET_COLUMNS
#define GROUP_ROWS (2 * PACKET_ROWS)
#define GROUP_AT(column, row) (2 * ((row) / 2 * PACKET_COLUMNS + (column)) + (row) % 2)

typedef struct RayPacket {
  float3 origin;
  float16 x[PACKET_GROUPS], y[PACKET_GROUPS], z[PACKET_GROUPS]; /* unit directions */
  float t_min, t_max;
} RayPacket;

typedef struct PacketHits {
  float16 t[PACKET_GROUPS];
  uint16 splat[PACKET_GROUPS]; /* or NO_SPLAT */
} PacketHits;

/* Smallest of the lanes of four vectors at once. */
static inline float4 smallest_of(float16 a, float16 b, float16 c, float16 d) {
  const float8 a8 = min(a.lo, a.hi), b8 = min(b.lo, b.hi), c8 = min(c.lo, c.hi), d8 = min(d.lo, d.hi);
  const float4 a4 = min(a8.lo, a8.hi), b4 = min(b8.lo, b8.hi), c4 = min(c8.lo, c8.hi), d4 = min(d8.lo, d8.hi);
  const float4 ab = min((float4)(a4.lo, b4.lo), (float4)(a4.hi, b4.hi));
  const float4 cd = min((float4)(c4.lo, d4.lo), (float4)(c4.hi, d4.hi));
  return min((float4)(ab.xz, cd.xz), (float4)(ab.yw, cd.yw));
}

/* What the rays of a packet have in common. */
typedef struct PacketBounds {
  float3 origin;
  float3 inverse_low, inverse_high; /* bounds of 1/direction; unused on open axes */
  int3 open;                        /* axes on which directions of both signs, or none, stand: no bound there */
  uint octant;
  /* Frusta, in a frame of unit vectors: the rays of a column of pixels run inside u_low <= u/along <= u_high, those of a
   * row of half pixels inside v_low <= v/along <= v_high. */
  float3 along, u, v;
  float u_low[GROUP_COLUMNS], u_high[GROUP_COLUMNS];
  float v_low[GROUP_ROWS], v_high[GROUP_ROWS];
  float stretch; /* of a length measured along u or v against the distance from a side of a frustum */
  bool wide;     /* rays more than 60 degrees off the middle: no frustum, every disc meets them */
} PacketBounds;

static inline float16 packet_dot(const RayPacket* p, int group, float3 v) {
  return p->x[group] * v.x + p->y[group] * v.y + p->z[group] * v.z;
}

/* A frame about the middle of a box around the directions, u along a row of a pixel's grid of rays. */
static inline void packet_frame(const RayPacket* p, float3 middle, PacketBounds* b) {
  const float length2 = dot3(middle, middle);
  b->along = length2 > 1e-6f ? middle / sqrt(length2) : (float3)(0.0f, 0.0f, 1.0f);
  float3 row = (float3)(p->x[0].s7 - p->x[0].s0, p->y[0].s7 - p->y[0].s0, p->z[0].s7 - p->z[0].s0);
  row -= dot3(row, b->along) * b->along;
  const float row2 = dot3(row, row);
  if (row2 > 1e-12f)
    b->u = row / sqrt(row2);
  else
    tangents(b->along, &b->u, &b->v);
  b->v = cross(b->along, b->u);
}

static inline void packet_frusta(const RayPacket* p, PacketBounds* b) {
  for (int c = 0; c < GROUP_COLUMNS; ++c)
    b->u_low[c] = INFINITY, b->u_high[c] = -INFINITY;
  for (int r = 0; r < GROUP_ROWS; ++r)
    b->v_low[r] = INFINITY, b->v_high[r] = -INFINITY;
  float flattest = INFINITY, steepest = 0.0f;
  for (int r = 0; r < GROUP_ROWS; ++r)
    for (int c = 0; c < GROUP_COLUMNS; ++c) {
      const int group = GROUP_AT(c, r);
      const float16 along = packet_dot(p, group, b->along), scale = 1.0f / along;
      const float16 u = packet_dot(p, group, b->u) * scale, v = packet_dot(p, group, b->v) * scale;
      const float4 least = smallest_of(u, v, -u, -v) - 1e-6f; /* directions are known to 1e-7 */
      b->u_low[c] = min(b->u_low[c], least.x);
      b->u_high[c] = max(b->u_high[c], -least.z);
      b->v_low[r] = min(b->v_low[r], least.y);
      b->v_high[r] = max(b->v_high[r], -least.w);
      const float8 a8 = min(along.lo, along.hi);
      flattest = min(flattest, smallest8(a8));
      steepest = max(steepest, max(max(fabs(least.x), fabs(least.y)), max(fabs(least.z), fabs(least.w))));
    }
  /* Farther off, the margin above would not cover the rounding of u/along, about 2e-7 / along^2. */
  b->wide = !(flattest > 0.5f);
  b->stretch = b->wide ? 1.0f : sqrt(1.0f + steepest * steepest);
}

static inline PacketBounds packet_bounds(const RayPacket* p) {
  PacketBounds b;
  b.origin = p->origin;
  float16 x0 = p->x[0], y0 = p->y[0], z0 = p->z[0], x1 = x0, y1 = y0, z1 = z0;
  for (int g = 1; g < PACKET_GROUPS; ++g) {
    x0 = min(x0, p->x[g]), y0 = min(y0, p->y[g]), z0 = min(z0, p->z[g]);
    x1 = max(x1, p->x[g]), y1 = max(y1, p->y[g]), z1 = max(z1, p->z[g]);
  }
  const float3 low = smallest_of(x0, y0, z0, z0).xyz, high = -smallest_of(-x1, -y1, -z1, -z1).xyz;
  b.open = (low < 1e-12f) & (high > -1e-12f);
  b.inverse_low = 1.0f / high;
  b.inverse_high = 1.0f / low;
  packet_frame(p, low + high, &b);
  b.octant = (b.along.x < 0.0f ? 1u : 0u) | (b.along.y < 0.0f ? 2u : 0u) | (b.along.z < 0.0f ? 4u : 0u);
  packet_frusta(p, &b);
  return b;
}

/* Bounds of t on one axis for all rays and eight boxes. */
static inline void packet_slab(const __global float* low, const __global float* high, float origin, float inverse_low,
                               float inverse_high, int open, float8* t0, float8* t1) {
  if (open)
    return;
  const bool down = inverse_high < 0.0f;
  const float8 first = vload8(0, down ? high : low) - origin, last = vload8(0, down ? low : high) - origin;
  *t0 = max(*t0, min(first * inverse_low, first * inverse_high));
  *t1 = min(*t1, max(last * inverse_low, last * inverse_high));
}

/* children_met for the packet: a child is met when some ray may meet it. */
static inline ulong children_met_by_packet(const __global WideNode* node, const PacketBounds* b, float t_from, float t_to,
                                           float8* t_enter) {
  float8 t0 = (float8)(t_from), t1 = (float8)(t_to);
  packet_slab(node->low[0], node->high[0], b->origin.x, b->inverse_low.x, b->inverse_high.x, b->open.x, &t0, &t1);
  packet_slab(node->low[1], node->high[1], b->origin.y, b->inverse_low.y, b->inverse_high.y, b->open.y, &t0, &t1);
  packet_slab(node->low[2], node->high[2], b->origin.z, b->inverse_low.z, b->inverse_high.z, b->open.z, &t0, &t1);
  *t_enter = t0;
  int8 met = t0 <= t1;
  if (b->open.x | b->open.y | b->open.z) /* there empty children's inverted boxes were not looked at */
    met &= vload8(0, node->low[0]) <= vload8(0, node->high[0]);
  return mirrored(byte_a_lane(met), b->octant);
}

#ifdef HAS_MLS
#define REACH_OF_SPLAT 1.1181f /* over the radius: of the ball about a patch, rounded up */
#define BEND_OF_LANE(block, lane)                                                                  \
  (float3)(block[WIDE_BEND(WIDE_LANES, 0) + lane], block[WIDE_BEND(WIDE_LANES, 1) + lane], block[WIDE_BEND(WIDE_LANES, 2) + lane])
#else
#define REACH_OF_SPLAT 1.0f
#define BEND_OF_LANE(block, lane) (float3)(0.0f)
#endif

/* For each splat of a block, a bit a group of rays whose frustum its bounding sphere reaches into before t_to. */
static inline lanes_i groups_met(const __global float* block, const PacketBounds* b, float t_to) {
  const lanes_f radius = load_lanes(block + WIDE_RADIUS(WIDE_LANES));
  if (b->wide)
    return (radius > 0.0f) & ((1 << PACKET_GROUPS) - 1);
  const lanes_f x = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 0)) - b->origin.x;
  const lanes_f y = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 1)) - b->origin.y;
  const lanes_f z = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 2)) - b->origin.z;
  const lanes_f a = x * b->along.x + y * b->along.y + z * b->along.z;
  const lanes_f u = x * b->u.x + y * b->u.y + z * b->u.z;
  const lanes_f v = x * b->v.x + y * b->v.y + z * b->v.z;
  const lanes_f reach = REACH_OF_SPLAT * radius * b->stretch + 1e-6f;
  const lanes_i near = (radius > 0.0f) & (a + reach >= 0.0f) & (a - reach <= t_to);
  lanes_i columns[GROUP_COLUMNS];
  for (int c = 0; c < GROUP_COLUMNS; ++c)
    columns[c] = near & (u - b->u_high[c] * a <= reach) & (b->u_low[c] * a - u <= reach);
  lanes_i met = (lanes_i)(0);
  for (int r = 0; r < GROUP_ROWS; ++r) {
    const lanes_i row = (v - b->v_high[r] * a <= reach) & (b->v_low[r] * a - v <= reach);
    for (int c = 0; c < GROUP_COLUMNS; ++c)
      met |= row & columns[c] & (1 << GROUP_AT(c, r));
  }
  return met;
}

#ifdef HAS_CLIPS
/* is_clipped_off of a group's rays at t. centre: from the rays' origin. */
static inline int16 clipped_off_group(const RayPacket* p, int group, float16 t, float3 centre,
                                      const __global float* clip) {
  const float16 x = fma(t, p->x[group], (float16)(-centre.x)), y = fma(t, p->y[group], (float16)(-centre.y)),
                z = fma(t, p->z[group], (float16)(-centre.z));
  int16 outside = (int16)(0);
  for (int k = 0; k < CLIP_STRIPS; ++k, clip += STRIP_WORDS) {
    const float3 axis = STRIP_AXIS(clip);
    const float16 s = fma((float16)(axis.x), x, fma((float16)(axis.y), y, axis.z * z));
    outside |= (s < STRIP_LOW(clip)) | (s > STRIP_HIGH(clip));
  }
  return outside;
}
#endif

/* Keeps the hits of a group's rays with a splat where they are nearer. `inside`: which there are. `clip`: null where the splat
 * has none. */
static inline void keep_nearer(const RayPacket* p, int group, float16 t, int16 inside, float3 centre,
                               const __global float* clip, uint index, PacketHits* best) {
  const float16 t_best = best->t[group];
  const uint16 splat_best = best->splat[group];
#ifdef HAS_CLIPS
  if (clip != 0)
    inside &= ~clipped_off_group(p, group, t, centre, clip);
#endif
  const int16 nearer = inside & (t > p->t_min) &
                       ((t < t_best) | ((t == t_best) & (as_int16((uint16)(index) < splat_best))));
  best->t[group] = select(t_best, t, nearer);
  best->splat[group] = select(splat_best, (uint16)(index), nearer);
}

/* One splat against one group of rays. `bend`: of its patch, where splats are patches. */
static inline void hit_group(const RayPacket* p, int group, float3 centre, float radius, float3 normal, float3 bend,
                             const __global float* clip, uint index, PacketHits* best) {
#ifdef HAS_MLS
  const PatchRays r = patch_rays(p->x[group], p->y[group], p->z[group], centre, radius, normal, bend);
  float16 s = r.near_s;
  for (int root = 0; root < 2; ++root) {
    const int16 met = s < INFINITY;
    if ((byte_a_lane(met.lo) | byte_a_lane(met.hi)) == 0ul)
      break;
    keep_nearer(p, group, r.t + s,
                met AND_SIDE_COUNTS(cosines_of_rays(&r, s, p->x[group], p->y[group], p->z[group], normal, bend)), centre, clip,
                index, best);
    s = r.far_s;
  }
#else
  int16 inside;
  const float16 t = meet_rays(p->x[group], p->y[group], p->z[group], centre, radius, normal, &inside);
  keep_nearer(p, group, t,
              inside AND_SIDE_COUNTS(fma((float16)(normal.x), p->x[group],
                                         fma((float16)(normal.y), p->y[group], normal.z * p->z[group]))),
              centre, clip, index, best);
#endif
}

/* The splats of a block that reach into the packet, against the rays that they reach. */
static inline void hit_block_by_packet(const __global float* blocks, const __global float* block, const RayPacket* p, const PacketBounds* bounds,
                                       float t_to, PacketHits* best) {
  const lanes_i met = groups_met(block, bounds, t_to);
  int groups_of[WIDE_LANES];
  store_lanes(met, groups_of);
  const uint first = as_uint(block[WIDE_FIRST(WIDE_LANES)]);
#ifdef HAS_CLIPS
  const uint clipped = as_uint(block[WIDE_CLIPPED(WIDE_LANES)]);
#endif
  for (int part = 0; part < WIDE_LANES / 8; ++part)
    for (ulong left = byte_a_lane(vload8(part, groups_of) != 0); left != 0ul; left &= left - 1ul) {
      const uint lane = 8u * part + lowest_byte(left);
      const float3 centre = (float3)(block[WIDE_CENTRE(WIDE_LANES, 0) + lane], block[WIDE_CENTRE(WIDE_LANES, 1) + lane],
                                     block[WIDE_CENTRE(WIDE_LANES, 2) + lane]) - p->origin;
      const float3 normal = (float3)(block[WIDE_NORMAL(WIDE_LANES, 0) + lane], block[WIDE_NORMAL(WIDE_LANES, 1) + lane],
                                     block[WIDE_NORMAL(WIDE_LANES, 2) + lane]);
      const float3 bend = BEND_OF_LANE(block, lane);
      const __global float* clip = 0;
#ifdef HAS_CLIPS
      if (clipped & (1u << lane))
        clip = blocks + as_uint(block[WIDE_CLIPS(WIDE_LANES)]) + CLIP_WORDS * popcount(clipped & ((1u << lane) - 1u));
#endif
      for (uint groups = groups_of[lane]; groups != 0u; groups &= groups - 1u)
        hit_group(p, popcount((groups & (0u - groups)) - 1u), centre, block[WIDE_RADIUS(WIDE_LANES) + lane], normal,
                  bend, clip, first + lane, best);
    }
}

static inline float farthest_hit(const PacketHits* hits) {
  float16 t = hits->t[0];
  for (int g = 1; g < PACKET_GROUPS; ++g)
    t = max(t, hits->t[g]);
  return -smallest8(-max(t.lo, t.hi));
}

static inline void trace_packet(POOL_PARAMS, const RayPacket* p, PacketHits* best) {
  for (int g = 0; g < PACKET_GROUPS; ++g) {
    best->t[g] = (float16)(p->t_max);
    best->splat[g] = (uint16)(NO_SPLAT);
  }
  const PacketBounds bounds = packet_bounds(p);
  float farthest = p->t_max;
  WALK_FROM_ROOT(walk);
  while (walk.count > 0) {
    walk.count -= 1;
    if (walk.t_enter[walk.count] > farthest)
      continue;
    const uint current = walk.waiting[walk.count];
    if (!(current & WIDE_LEAF)) {
      float8 t_enter;
      const ulong met = children_met_by_packet(node_pool + current, &bounds, p->t_min, farthest, &t_enter);
      push_children(&walk, node_pool + current, met, t_enter, bounds.octant);
      continue;
    }
    FOR_BLOCKS_OF_LEAF(current, block, { hit_block_by_packet(block_pool, block, p, &bounds, farthest, best); })
    farthest = farthest_hit(best);
  }
}
