/* 32 rays from one origin through the wide form at once, two vectors of 16 a work-item: for eye rays of one pixel, on
 * devices whose work-items have vector registers of their own. A node is tested once for all rays, by bounds of their
 * inverse directions; a block of splats once, by the cone around them; only splats inside the cone meet the 32 rays.
 * Answers are those of trace_closest to the bit. */
#include "lib/wide_traversal.cl"

typedef struct RayPacket {
  float3 origin;
  float16 dx0, dy0, dz0, dx1, dy1, dz1; /* unit directions of rays 0-15 and 16-31 */
  float t_min, t_max;
} RayPacket;

typedef struct PacketHits {
  float16 t0, t1;
  uint16 splat0, splat1; /* or NO_SPLAT */
} PacketHits;

static inline float smallest16(float16 v) { return smallest8(fmin(v.lo, v.hi)); }
static inline float largest16(float16 v) { return -smallest16(-v); }

static inline float sum16(float16 v) {
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
}

/* What all rays of a packet have in common. */
typedef struct PacketBounds {
  float3 origin, axis;             /* axis: unit, the middle of the rays */
  float3 inverse_low, inverse_high; /* bounds of 1/direction; unused on open axes */
  int3 open;                       /* axes on which directions of both signs, or none, stand: no bound there */
  float tangent;                   /* of the angle between the axis and the ray farthest from it */
  uint octant;
} PacketBounds;

static inline PacketBounds packet_bounds(const RayPacket* p) {
  PacketBounds b;
  b.origin = p->origin;
  const float3 low = (float3)(smallest16(fmin(p->dx0, p->dx1)), smallest16(fmin(p->dy0, p->dy1)), smallest16(fmin(p->dz0, p->dz1)));
  const float3 high = (float3)(largest16(fmax(p->dx0, p->dx1)), largest16(fmax(p->dy0, p->dy1)), largest16(fmax(p->dz0, p->dz1)));
  b.open = (low < 1e-12f) & (high > -1e-12f);
  b.inverse_low = 1.0f / high;
  b.inverse_high = 1.0f / low;
  b.axis = normalize3((float3)(sum16(p->dx0 + p->dx1), sum16(p->dy0 + p->dy1), sum16(p->dz0 + p->dz1)));
  const float16 c0 = p->dx0 * b.axis.x + p->dy0 * b.axis.y + p->dz0 * b.axis.z;
  const float16 c1 = p->dx1 * b.axis.x + p->dy1 * b.axis.y + p->dz1 * b.axis.z;
  const float cosine = smallest16(fmin(c0, c1));
  /* Rounding of a cosine near 1 hides angles below 5e-4: added, and the cone stays a bound. */
  b.tangent = cosine > 0.1f ? sqrt(fmax(0.0f, 1.0f - cosine * cosine)) / cosine + 5e-4f : INFINITY;
  b.octant = (b.axis.x < 0.0f ? 1u : 0u) | (b.axis.y < 0.0f ? 2u : 0u) | (b.axis.z < 0.0f ? 4u : 0u);
  return b;
}

/* Bounds of t on one axis for all rays and eight boxes. */
static inline void packet_slab(const __global float* low, const __global float* high, float origin, float inverse_low,
                               float inverse_high, int open, float8* t0, float8* t1) {
  if (open)
    return;
  const float8 l = vload8(0, low) - origin, h = vload8(0, high) - origin;
  const bool down = inverse_high < 0.0f;
  const float8 first = down ? h : l, last = down ? l : h;
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
  /* On open axes empty children's inverted boxes were not looked at. */
  return mirrored(as_ulong(convert_char8((t0 <= t1) & (vload8(0, node->low[0]) <= vload8(0, node->high[0])))) & 0x0101010101010101ul,
                  b->octant);
}

/* Lanes of a block whose bounding spheres reach into the cone and begin before t_to. */
static inline lanes_i lanes_in_cone(const __global float* block, const PacketBounds* b, float t_to) {
  const lanes_f x = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 0)) - b->origin.x;
  const lanes_f y = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 1)) - b->origin.y;
  const lanes_f z = load_lanes(block + WIDE_CENTRE(WIDE_LANES, 2)) - b->origin.z;
  const lanes_f radius = load_lanes(block + WIDE_RADIUS(WIDE_LANES));
  const lanes_f along = x * b->axis.x + y * b->axis.y + z * b->axis.z;
  /* Across by the cross product: the difference of squares would lose it far from the origin. */
  const lanes_f cx = y * b->axis.z - z * b->axis.y, cy = z * b->axis.x - x * b->axis.z, cz = x * b->axis.y - y * b->axis.x;
  const lanes_f reach = radius + b->tangent * (along + radius) + 1e-6f;
  const lanes_i inside = (along + radius >= -1e-6f) & (along - radius <= t_to) &
                         (cx * cx + cy * cy + cz * cz <= reach * reach);
  /* Rays more than 84 degrees off their middle are no cone worth the name: every disc meets them. */
  return (radius > 0.0f) & (isinf(b->tangent) ? (lanes_i)(-1) : inside);
}

/* One disc against half of the packet, as ray_disc. */
static inline void hit_half(float16 dx, float16 dy, float16 dz, float3 centre, float radius, float3 normal, uint index,
                            float t_min, float16* best, uint16* splat) {
  const float16 t = dot3(normal, centre) / fma((float16)(normal.x), dx, fma((float16)(normal.y), dy, normal.z * dz));
  const float16 x = fma(t, dx, (float16)(-centre.x)), y = fma(t, dy, (float16)(-centre.y)), z = fma(t, dz, (float16)(-centre.z));
  const int16 nearer = (fma(x, x, fma(y, y, z * z)) <= radius * radius) & (t > t_min) &
                       ((t < *best) | ((t == *best) & (as_int16((uint16)(index) < *splat))));
  *best = select(*best, t, nearer);
  *splat = select(*splat, (uint16)(index), nearer);
}

static inline PacketHits trace_packet(POOL_PARAMS, const RayPacket* p) {
  PacketHits best;
  best.t0 = best.t1 = (float16)(p->t_max);
  best.splat0 = best.splat1 = (uint16)(NO_SPLAT);
  const PacketBounds bounds = packet_bounds(p);
  float farthest = p->t_max;
  WideWalk walk;
  walk_from_root(&walk);
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
    FOR_BLOCKS_OF_LEAF(current, block, {
      const lanes_i inside = lanes_in_cone(block, &bounds, farthest);
      if (any(inside)) {
        int wanted[WIDE_LANES];
        store_lanes(inside, wanted);
        const uint first = as_uint(block[WIDE_FIRST(WIDE_LANES)]);
        for (uint lane = 0u; lane < WIDE_LANES; ++lane)
          if (wanted[lane] != 0) {
            const float3 centre = (float3)(block[WIDE_CENTRE(WIDE_LANES, 0) + lane], block[WIDE_CENTRE(WIDE_LANES, 1) + lane],
                                           block[WIDE_CENTRE(WIDE_LANES, 2) + lane]) - p->origin;
            const float3 normal = (float3)(block[WIDE_NORMAL(WIDE_LANES, 0) + lane], block[WIDE_NORMAL(WIDE_LANES, 1) + lane],
                                           block[WIDE_NORMAL(WIDE_LANES, 2) + lane]);
            const float radius = block[WIDE_RADIUS(WIDE_LANES) + lane];
            hit_half(p->dx0, p->dy0, p->dz0, centre, radius, normal, first + lane, p->t_min, &best.t0, &best.splat0);
            hit_half(p->dx1, p->dy1, p->dz1, centre, radius, normal, first + lane, p->t_min, &best.t1, &best.splat1);
          }
      }
    })
    farthest = largest16(fmax(best.t0, best.t1));
  }
  return best;
}
