/* Sample positions: strata of a pixel's 32 rays, and light samples stratified over the same 32. */
#include "lib/rng.cl"
#include "lib/vector.cl"
#include "shared/render_types.h"

/* What the random numbers of one ray are made from. */
typedef struct SampleId {
  uint2 pixel;
  uint sample; /* of the pixel; sample / 32 is its pass, sample % 32 its number in the pass */
  uint seed;
  uint vertex; /* of the ray's path: 0 what the camera sees, then the places where bounced rays end */
} SampleId;

#define VERTEX_DIMENSIONS 8u /* uses of random numbers at one vertex */

/* Four numbers in [0,1) for one use, `dimension`, of one ray. */
static inline float4 random4(SampleId id, uint dimension) {
  dimension += VERTEX_DIMENSIONS * id.vertex;
  const uint4 h = pcg4d((uint4)(id.pixel.x, id.pixel.y, id.sample, id.seed * 0x9E3779B9u + dimension));
  return (float4)(unit_float(h.x), unit_float(h.y), unit_float(h.z), unit_float(h.w));
}

/* Two numbers in [0,1), stratified over 32 samples of the pixel: the (0,2)-sequence of van der Corput and Sobol, whose
 * every power-of-two prefix is stratified, so that 1, 8 or 32 samples are all served well (Kollig and Keller, "Efficient
 * Multidimensional Sampling", 2002). A random XOR a pixel, use and pass of 32: one XOR for all passes would tie each cell
 * of the pixel's grid, and each use, to the same part of every other for good, and the mean of many samples would
 * converge to something else. Only at a path's first vertex; behind it two uses could not both be stratified without
 * such ties. z and w are plain random numbers. */
static inline float4 stratified4(SampleId id, uint dimension) {
  const float4 r = random4(id, dimension);
  if (id.vertex > 0u)
    return r;
  const uint4 scramble = pcg4d((uint4)(id.pixel.x, id.pixel.y, 0x68E31DA4u + id.sample / GRID_RAYS,
                                       id.seed * 0x9E3779B9u + dimension));
  uint first = 0u, second = 0u, bit = 1u << 31, direction = 1u << 31;
  for (uint rest = id.sample % GRID_RAYS; rest != 0u; rest >>= 1) {
    if (rest & 1u) {
      first ^= bit;
      second ^= direction;
    }
    bit >>= 1;
    direction ^= direction >> 1;
  }
  return (float4)(unit_float(first ^ scramble.x), unit_float(second ^ scramble.y), r.z, r.w);
}

/* The strata of one pass of a pixel's samples: 32 of them, fewer in the last pass. A pass of 32 is the 8x4 grid; one of
 * 1, 2, 4, 8 or 16 a coarser grid: 1x1, 2x1, 2x2, 4x2, 4x4. Any other pass of n has n columns and n rows, and one sample
 * in each of both, so that it too is spread over the whole pixel. The columns, and the rows, are shifted round by a random
 * number of them, or some places of the pixel would never be sampled. */
typedef struct PixelPass {
  uint2 strata; /* columns, rows */
  uint2 taken;  /* 0: a grid; else bit c: the sequence of the columns (rows) takes the value c in this pass */
  uint2 shift;
} PixelPass;

/* The sequences that order columns and rows, of which every prefix is spread as well: dimensions 3 and 4 of Sobol's
 * sequence, the first five bits (direction numbers of Joe and Kuo, "Constructing Sobol sequences with better
 * two-dimensional projections", 2008). stratified4 has dimensions 1 and 2: were they the same, the left of the pixel
 * would meet one half of a light. i: a number, or a vector of numbers, below 32. */
#define COLUMN_SEQUENCE(i) \
  (((i) & 1u) * 16u ^ ((i) >> 1u & 1u) * 24u ^ ((i) >> 2u & 1u) * 12u ^ ((i) >> 3u & 1u) * 18u ^ ((i) >> 4u & 1u) * 29u)
#define ROW_SEQUENCE(i) \
  (((i) & 1u) * 16u ^ ((i) >> 1u & 1u) * 24u ^ ((i) >> 2u & 1u) * 4u ^ ((i) >> 3u & 1u) * 10u ^ ((i) >> 4u & 1u) * 31u)

/* Of the pass that the sample belongs to. */
static inline PixelPass pixel_pass(SampleId id, uint samples, bool jitter) {
  const uint pass = id.sample / GRID_RAYS, n = min(samples - pass * GRID_RAYS, (uint)GRID_RAYS);
  PixelPass p = {(uint2)(n > 16u ? GRID_X : n > 4u ? 4u : n > 1u ? 2u : 1u, n > 8u ? GRID_Y : n > 2u ? 2u : 1u),
                 (uint2)(0u), (uint2)(0u)};
  if (popcount(n) == 1u)
    return p;
  p.strata = (uint2)(n);
  for (uint i = 0u; i < n; ++i)
    p.taken |= (uint2)(1u << COLUMN_SEQUENCE(i), 1u << ROW_SEQUENCE(i));
  if (jitter) {
    const uint4 h = pcg4d((uint4)(id.pixel.x, id.pixel.y, 0x68E31DA4u + pass, id.seed * 0x9E3779B9u));
    p.shift = (uint2)(h.x % n, h.y % n);
  }
  return p;
}

/* Column and row of sample i of the pass; `type`: of i, uint or a vector of them. */
#define STRATA_OF_SAMPLE(pass, type, i, column, row)                                                                    \
  do {                                                                                                                  \
    if ((pass).taken.x == 0u) {                                                                                         \
      column = (i) % (pass).strata.x;                                                                                   \
      row = (i) / (pass).strata.x;                                                                                      \
    } else { /* the rank of its value among those of the pass */                                                        \
      const type column_bit = (type)(1u) << COLUMN_SEQUENCE(i), row_bit = (type)(1u) << ROW_SEQUENCE(i);                \
      column = (popcount((pass).taken.x & (column_bit - 1u)) + (pass).shift.x) % (pass).strata.x;                       \
      row = (popcount((pass).taken.y & (row_bit - 1u)) + (pass).shift.y) % (pass).strata.y;                             \
    }                                                                                                                   \
  } while (0)

/* Place in the pixel, [0,1)^2: somewhere in the sample's stratum, or in its middle. */
static inline float2 place_in_pixel(SampleId id, uint samples, bool jitter) {
  const PixelPass pass = pixel_pass(id, samples, jitter);
  const uint i = id.sample % GRID_RAYS;
  uint column, row;
  STRATA_OF_SAMPLE(pass, uint, i, column, row);
  const float4 r = random4(id, 0u);
  const float u = jitter ? r.x : 0.5f, v = jitter ? r.y : 0.5f;
  return (float2)(((float)column + u) / (float)pass.strata.x, ((float)row + v) / (float)pass.strata.y);
}

/* Unit vector about n, density cos/pi. */
static inline float3 cosine_direction(float3 n, float u, float v) {
  float3 a, b;
  tangents(n, &a, &b);
  const float r = sqrt(u), phi = 6.2831853f * v;
  return normalize3(r * cos(phi) * a + r * sin(phi) * b + sqrt(fmax(0.0f, 1.0f - u)) * n);
}

/* A direction of a cone about `axis`, unit, of sine^2 s2 of its half angle, or any direction where s2 >= 1; density 1 over
 * *solid_angle. */
static inline float3 cone_direction(float3 axis, float s2, float2 u, float* solid_angle) {
  const float height = s2 >= 1.0f ? 2.0f : s2 / (1.0f + sqrt(1.0f - s2)); /* 1 - cosine of the half angle */
  *solid_angle = 6.2831853f * height;
  const float down = u.x * height, r = sqrt(fmax(0.0f, down * (2.0f - down))), phi = 6.2831853f * u.y;
  float3 a, b;
  tangents(axis, &a, &b);
  return normalize3((1.0f - down) * axis + r * cos(phi) * a + r * sin(phi) * b);
}

/* Index of the first entry whose cumulative share exceeds u, for entries `stride` floats apart. */
static inline uint pick(const __global float* cumulative, uint stride, uint count, float u) {
  uint low = 0u, high = count - 1u;
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (cumulative[middle * stride] > u)
      high = middle;
    else
      low = middle + 1u;
  }
  return low;
}
