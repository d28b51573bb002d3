/* Sample positions: strata of a pixel's 32 rays, and light samples stratified over the same 32. */
#include "lib/rng.cl"
#include "lib/vector.cl"
#include "shared/render_types.h"

/* What the random numbers of one ray are made from. */
typedef struct SampleId {
  uint2 pixel;
  uint sample; /* of the pixel; sample % 32 is its place in the 8x4 grid, sample / 32 the pass */
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

/* Place in the pixel, [0,1)^2: sample (i, j) of the 8x4 grid at ((i+u)/8, (j+v)/4). With fewer than 32 samples the
 * grid is coarser: 1 -> 1x1, 2 -> 2x1, 4 -> 2x2, 8 -> 4x2, 16 -> 4x4 (other counts leave cells of the next one empty). */
static inline uint2 grid_of(uint samples) {
  if (samples > 16u)
    return (uint2)(GRID_X, GRID_Y);
  return (uint2)(samples > 4u ? 4u : samples > 1u ? 2u : 1u, samples > 8u ? 4u : samples > 2u ? 2u : 1u);
}

static inline float2 place_in_pixel(SampleId id, uint samples, bool jitter) {
  const uint2 grid = grid_of(samples);
  const uint i = id.sample % GRID_RAYS;
  const float4 r = random4(id, 0u);
  const float u = jitter ? r.x : 0.5f, v = jitter ? r.y : 0.5f;
  return (float2)(((float)(i % grid.x) + u) / (float)grid.x, ((float)(i / grid.x) + v) / (float)grid.y);
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
