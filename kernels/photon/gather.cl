/* The k nearest photons of a place, and the irradiance that they make (method.md section 5).
 *   GATHER_MOST  the largest k, a multiple of 16: private memory for that many photons and a spare
 *   GATHER_SURFACE  defined: photons count as of a surface (surface_distance2); else by distance alone
 * Written in vectors of the language, for devices whose work-items have vector registers of their own.
 * The walk keeps no stack: the nodes are numbered as in a heap, and of each level a byte tells which children are left. */
#ifndef GATHER_MOST
#define GATHER_MOST 64
#endif
#include "lib/lanes8.cl"
#include "lib/vector.cl"
#include "shared/photon_types.h"

/* Photons beyond k within the bound before it is drawn closer. */
#ifndef GATHER_PATIENCE
#define GATHER_PATIENCE 32
#endif
/* Places in the list of candidates, whole buckets: at 50 and at 500 photons a caustic fills two thirds of it. When it is
 * full, what the bound has left behind is thrown out. */
#define GATHER_ROOM (4 * GATHER_MOST + 256)
/* Nor do equal distances fill it: a bound is drawn of k + GATHER_PATIENCE + 15 candidates at most. Those that tie at it may
 * stay, but no photon at the bound becomes a candidate, and of nearer ones fewer than k + 16, or the bound would be theirs. */
#if GATHER_ROOM < 2 * GATHER_MOST + GATHER_PATIENCE + 64
#error "GATHER_PATIENCE: candidates that tie may fill the list"
#endif

/* Photons off a surface's plane belong to other surfaces, more likely the farther off they are: height counts four times
 * (Jensen 2001 flattens the sphere of the search likewise), squared and beside what it counts as part of the distance. */
#define HEIGHT_WEIGHT 15.0f

typedef struct PhotonPool {
  const __global PhotonNode* nodes;
  const __global float* buckets;
} PhotonPool;

/* Where photons are looked for. */
typedef struct GatherPlace {
  float3 position;
  float3 normal; /* unit, of the side that is lit; used by GATHER_SURFACE only */
} GatherPlace;

/* Candidates: the photons nearer than or at `within2` among the first `count`, a multiple of 16, of the list; others of
 * their buckets stand there infinitely far off, which costs less than to sort them out one by one. The arrays stand apart,
 * so that what is counted is kept in registers. */
typedef struct NearPhotons {
  float* distance2;
  uint* photon;
  uint count;
  uint within; /* candidates when the bound was drawn */
  uint fresh;  /* and since */
  float within2;
} NearPhotons;

#define NEAR_PHOTONS(name)                 \
  float name##_distance2[GATHER_ROOM];      \
  uint name##_photon[GATHER_ROOM];          \
  NearPhotons name = {name##_distance2, name##_photon, 0u, 0u, 0u, 0.0f}

static inline int sum16(int16 v) {
  const int8 a = v.lo + v.hi;
  const int4 b = a.lo + a.hi;
  return b.x + b.y + b.z + b.w;
}

static inline float sum16f(float16 v) {
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
}

static inline float largest16(float16 v) {
  const float8 a = max(v.lo, v.hi);
  const float4 b = max(a.lo, a.hi);
  return max(max(b.x, b.y), max(b.z, b.w));
}

static inline float smallest16(float16 v) { return smallest8(min(v.lo, v.hi)); }

/* The list cut at a bound. */
typedef struct Cut {
  uint count;    /* distances at most the bound */
  float largest; /* of them, or 0 */
  float above;   /* the smallest of the others, or INFINITY */
} Cut;

static inline Cut cut_at(const NearPhotons* near, float bound) {
  int16 count = 0;
  float16 largest = 0.0f, above = INFINITY;
  for (uint i = 0u; i < near->count; i += 16u) {
    const float16 d = vload16(0, near->distance2 + i);
    const int16 within = d <= bound;
    count += within;
    largest = max(largest, within ? d : (float16)(0.0f));
    above = min(above, within ? (float16)(INFINITY) : d);
  }
  const Cut cut = {(uint)-sum16(count), largest16(largest), smallest16(above)};
  return cut;
}

/* Draws the bound closer: to the k-th smallest distance of at least k, or to one of the `slack` behind it. Over a surface
 * distances squared are spread evenly, so where to cut between one that may be too small and one that is not is told by
 * their counts; every fourth cut halves instead, by the bits, which are in the order of the numbers. Each cut leaves one
 * distance less between the two, so that it ends. */
static inline void draw_bound(NearPhotons* near, uint k, uint slack) {
  uint count_enough = near->within + near->fresh, count_below = 0u; /* distances below `least` */
  if (count_enough < k)
    return;
  float enough = cut_at(near, near->within2).largest, least = 0.0f; /* the k-th is none smaller */
  for (uint step = 1u; count_enough > k + slack && least < enough; ++step) {
    const int low = as_int(least), high = as_int(enough);
    const float guess = least + (enough - least) * (((float)(k + slack / 2u - count_below) + 0.5f) /
                                                   (float)(count_enough - count_below));
    const bool halve = step % 4u == 0u || !(guess < enough);
    const Cut cut = cut_at(near, halve ? as_float(low + (high - low) / 2) : guess);
    if (cut.count < k) {
      least = cut.above;
      count_below = cut.count;
    } else {
      enough = cut.largest;
      count_enough = cut.count;
    }
  }
  near->within2 = enough;
  near->within = count_enough;
  near->fresh = 0u;
}

/* Throws out what the bound has left behind; what remains is padded to a whole bucket. */
static inline void throw_out(NearPhotons* near) {
  uint kept = 0u;
  for (uint i = 0u; i < near->count; ++i) {
    const float d = near->distance2[i];
    const uint photon = near->photon[i];
    near->distance2[kept] = d;
    near->photon[kept] = photon;
    kept += d <= near->within2 ? 1u : 0u;
  }
  for (; (kept & 15u) != 0u; ++kept) {
    near->distance2[kept] = INFINITY;
    near->photon[kept] = 0u; /* or 16 in a row might look like a whole bucket (add_powers) */
  }
  near->count = kept;
}

#ifdef GATHER_SURFACE
/* Components of directions: bits shift .. shift + 9, signed, times PHOTON_DIRECTION_SCALE. */
#define DIRECTION_LANES(bits, shift) convert_float16(as_int16((bits) << (22 - (shift))) >> 22)

/* Distances as a surface counts them: what arrives at its back is nowhere. */
static inline float16 surface_distance2(GatherPlace place, const __global float* bucket, float16 dx, float16 dy,
                                        float16 dz, float16 d2) {
  const uint16 bits = as_uint16(vload16(3, bucket));
  const float16 along = DIRECTION_LANES(bits, 0) * place.normal.x + DIRECTION_LANES(bits, 10) * place.normal.y +
                        DIRECTION_LANES(bits, 20) * place.normal.z;
  const float16 height = dx * place.normal.x + dy * place.normal.y + dz * place.normal.z;
  return along < 0.0f ? d2 + HEIGHT_WEIGHT * height * height : (float16)(INFINITY);
}
#endif

#define PHOTON_LANE_NUMBERS ((uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))

/* Squared, of a bucket's photons, as GATHER_SURFACE says. */
static inline float16 photon_distances2(GatherPlace place, const __global float* bucket) {
  const float16 dx = vload16(0, bucket) - place.position.x, dy = vload16(1, bucket) - place.position.y,
                dz = vload16(2, bucket) - place.position.z;
  const float16 d2 = dx * dx + dy * dy + dz * dz;
#ifdef GATHER_SURFACE
  return surface_distance2(place, bucket, dx, dy, dz, d2);
#else
  return d2;
#endif
}

/* Adds the photons of a bucket that are near enough. */
static inline void add_bucket(PhotonPool pool, GatherPlace place, uint k, uint bucket, NearPhotons* near) {
  const float16 d2 = photon_distances2(place, pool.buckets + (size_t)bucket * PHOTON_BUCKET_WORDS);
  const int16 found = d2 < near->within2;
  const uint number = (uint)popcount(byte_a_lane(found.lo) | (byte_a_lane(found.hi) << 1));
  if (number == 0u)
    return;
  vstore16(found ? d2 : (float16)(INFINITY), 0, near->distance2 + near->count);
  vstore16(bucket * PHOTON_LANES + PHOTON_LANE_NUMBERS, 0, near->photon + near->count);
  near->count += PHOTON_LANES;
  near->fresh += number;
  if (near->within + near->fresh >= k + GATHER_PATIENCE)
    draw_bound(near, k, GATHER_PATIENCE / 4u);
  if (near->count == GATHER_ROOM) {
    draw_bound(near, k, 0u);
    throw_out(near);
  }
}

/* Squares of the distances of a place from a node's eight boxes. */
static inline float8 box_distances2(const __global PhotonNode* node, float3 p) {
  const float8 none = 0.0f;
  const float8 dx = max(max(vload8(0, node->low[0]) - p.x, p.x - vload8(0, node->high[0])), none);
  const float8 dy = max(max(vload8(0, node->low[1]) - p.y, p.y - vload8(0, node->high[1])), none);
  const float8 dz = max(max(vload8(0, node->low[2]) - p.z, p.z - vload8(0, node->high[2])), none);
  return dx * dx + dy * dy + dz * dz;
}

#define CHILD_BITS ((int8)(1, 2, 4, 8, 16, 32, 64, 128))
#define CHILD_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))

/* Bit k is bit 0 of byte k, of bytes 0 or 1. */
static inline ulong bit_a_byte(ulong bytes) { return (bytes * 0x0102040810204080ul) >> 56; }

/* Adds the buckets under a node, nearest first. */
static inline void add_buckets(PhotonPool pool, GatherPlace place, uint k, uint first, float8 distance, NearPhotons* near) {
  for (;;) {
    const float nearest = smallest8(distance);
    if (!(nearest < near->within2))
      break;
    const uint child = lowest_byte(byte_a_lane(distance == nearest));
    distance = select(distance, (float8)(INFINITY), (int8)((int)child) == CHILD_NUMBERS);
    add_bucket(pool, place, k, first + child, near);
  }
}

/* Where a walk through the map is: of the node's children, and of its parents', a bit each for those that are left. */
typedef struct PhotonWalk {
  ulong left; /* the node's in the lowest byte, its parent's in the next */
  uint node, level;
} PhotonWalk;

static inline PhotonWalk walk_from_root(void) {
  const PhotonWalk walk = {0xfful, 0u, 0u};
  return walk;
}

/* Goes on to a node over buckets, of which some are nearer than sqrt(bound2), those that are near first: *first, its first
 * bucket, and the squared distances of all eight. False when there is no other. The bound may be drawn closer in between. */
static inline bool next_buckets(PhotonPool pool, __constant GatherParams* params, float3 position, float bound2,
                                PhotonWalk* walk, uint* first, float8* distance) {
  if (params->levels == 0u)
    return false;
  const uint bottom = params->levels - 1u, first_at_bottom = ((1u << (3u * bottom)) - 1u) / 7u;
  for (;;) {
    while (walk->level > 0u && (walk->left & 0xfful) == 0ul) {
      walk->node = (walk->node - 1u) >> 3;
      walk->level -= 1u;
      walk->left >>= 8;
    }
    if ((walk->left & 0xfful) == 0ul)
      return false;
    const float8 d2 = box_distances2(pool.nodes + walk->node, position);
    const int8 open = ((int8)((int)(walk->left & 0xfful)) & CHILD_BITS) != 0;
    *distance = select((float8)(INFINITY), d2, open);
    walk->left &= ~0xfful;
    if (walk->level == bottom) {
      *first = (walk->node - first_at_bottom) * PHOTON_CHILDREN;
      return true;
    }
    const float nearest = smallest8(*distance);
    if (!(nearest < bound2))
      continue;
    const uint child = lowest_byte(byte_a_lane(*distance == nearest));
    walk->left |= bit_a_byte(byte_a_lane(*distance < bound2)) & ~(1ul << child);
    walk->node = PHOTON_CHILDREN * walk->node + 1u + child;
    walk->level += 1u;
    walk->left = (walk->left << 8) | 0xfful;
  }
}

/* Fills the list from an empty one: its candidates are in the end the k nearest photons, or all there are nearer than
 * sqrt(near->within2); more where several are equally far. */
static inline void walk_photons(PhotonPool pool, __constant GatherParams* params, GatherPlace place, uint k,
                                NearPhotons* near) {
  PhotonWalk walk = walk_from_root();
  uint first;
  float8 distance;
  while (next_buckets(pool, params, place.position, near->within2, &walk, &first, &distance))
    add_buckets(pool, place, k, first, distance, near);
  draw_bound(near, k, 0u);
}

/* As walk_photons, from a bound that passes by everything farther from the beginning: first one that is hoped for, then, if
 * too few are nearer, one that is as good as sure, then the largest there is. */
static inline void nearest_photons(PhotonPool pool, __constant GatherParams* params, GatherPlace place, uint k,
                                   float hope2, float guess2, NearPhotons* near) {
  /* Finite: what arrives at the back is infinitely far, and would never be thrown out. */
  const float most2 = min(params->radius2, FLT_MAX);
  guess2 = min(guess2, most2);
  near->within2 = min(hope2, guess2);
  for (;;) {
    const float begun = near->within2;
    near->count = near->within = near->fresh = 0u;
    walk_photons(pool, params, place, k, near);
    if (near->within + near->fresh >= k || begun >= most2)
      break;
    near->within2 = begun < guess2 ? guess2 : most2;
  }
}

/* A bound for a place from that of another `apart` from it: the k-th nearest photon is at most that much farther. The
 * rest is rounding. */
static inline float bound_from(float within2, float apart) {
  const float r = (sqrt(within2) + apart) * 1.00001f;
  return r * r;
}

/* Adds the powers of the candidates among 16 of the list; of a whole bucket at once, unless some were thrown out. */
static inline void add_powers(PhotonPool pool, const NearPhotons* near, uint b, float16* red, float16* green,
                              float16* blue) {
  const float16 d = vload16(0, near->distance2 + b);
  const int16 takes = d <= near->within2;
  const ulong left = byte_a_lane(takes.lo) | (byte_a_lane(takes.hi) << 1);
  const uint first = near->photon[b];
  if (left == 0ul)
    return;
  if (first % PHOTON_LANES == 0u && near->photon[b + 15u] == first + 15u) {
    const __global float* words = pool.buckets + (size_t)(first / PHOTON_LANES) * PHOTON_BUCKET_WORDS;
    *red += takes ? vload16(4, words) : 0.0f;
    *green += takes ? vload16(5, words) : 0.0f;
    *blue += takes ? vload16(6, words) : 0.0f;
    return;
  }
  for (uint i = b; i < b + PHOTON_LANES; ++i)
    if (near->distance2[i] <= near->within2) {
      const __global float* words = pool.buckets + (size_t)(near->photon[i] / PHOTON_LANES) * PHOTON_BUCKET_WORDS;
      const uint lane = near->photon[i] % PHOTON_LANES;
      (*red).s0 += words[4u * PHOTON_LANES + lane];
      (*green).s0 += words[5u * PHOTON_LANES + lane];
      (*blue).s0 += words[6u * PHOTON_LANES + lane];
    }
}

/* A disc of no radius would make what coincident photons bring infinite. */
#define SMALLEST_GATHER2 1e-12f

/* Irradiance [W/m2, scaled] by the k photons of the list, which nearest_photons has filled: their power over the disc out
 * to the farthest. That one is always on the rim, which would make the mean k / (k - 1) too large. Fewer than k: all over
 * the disc of the largest radius. */
static inline float3 irradiance_of(PhotonPool pool, __constant GatherParams* params, uint k, const NearPhotons* near) {
  const uint number = near->within + near->fresh;
  if (number == 0u)
    return (float3)(0.0f);
  float16 red = 0.0f, green = 0.0f, blue = 0.0f;
  for (uint b = 0u; b < near->count; b += PHOTON_LANES)
    add_powers(pool, near, b, &red, &green, &blue);
  const bool enough = number >= k;
  const float share = enough && number > 1u ? (float)(number - 1u) / (float)number : 1.0f;
  const float area = 3.14159265f * max(enough ? near->within2 : params->radius2, SMALLEST_GATHER2);
  return (float3)(sum16f(red), sum16f(green), sum16f(blue)) * (share / area);
}

#ifdef GATHER_SURFACE
/* Sum of the powers of all photons nearer than sqrt(bound2), which count the less the farther they are: 1 - d^2 / bound2
 * times (Epanechnikov's weight). */
static inline float3 power_within(PhotonPool pool, __constant GatherParams* params, GatherPlace place, float bound2) {
  float16 red = 0.0f, green = 0.0f, blue = 0.0f;
  PhotonWalk walk = walk_from_root();
  uint first;
  float8 distance;
  while (next_buckets(pool, params, place.position, bound2, &walk, &first, &distance)) {
    ulong left = byte_a_lane(distance < bound2);
    for (; left != 0ul; left &= left - 1ul) {
      const __global float* words = pool.buckets + (size_t)(first + lowest_byte(left)) * PHOTON_BUCKET_WORDS;
      const float16 weight = max(1.0f - photon_distances2(place, words) / bound2, 0.0f);
      red += weight * vload16(4, words);
      green += weight * vload16(5, words);
      blue += weight * vload16(6, words);
    }
  }
  return (float3)(sum16f(red), sum16f(green), sum16f(blue));
}
#endif
