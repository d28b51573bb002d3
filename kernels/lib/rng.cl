/* Counter-based random numbers: a value is a function of (seed, pixel, sample, dimension), so the picture does not
 * depend on tiles, threads or the order of launches. */

/* The pcg4d hash of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020, of four numbers, or of four
 * vectors of numbers, in place. */
#define PCG4D(x, y, z, w)                                                                                               \
  do {                                                                                                                  \
    x = x * 1664525u + 1013904223u, y = y * 1664525u + 1013904223u;                                                     \
    z = z * 1664525u + 1013904223u, w = w * 1664525u + 1013904223u;                                                     \
    x += y * w, y += z * x, z += x * y, w += y * z;                                                                     \
    x ^= x >> 16u, y ^= y >> 16u, z ^= z >> 16u, w ^= w >> 16u;                                                         \
    x += y * w, y += z * x, z += x * y, w += y * z;                                                                     \
  } while (0)

static inline uint4 pcg4d(uint4 v) {
  PCG4D(v.x, v.y, v.z, v.w);
  return v;
}

/* Uniform in [0, 1): 24 bits, so that the largest value stays below 1 in float. */
static inline float unit_float(uint bits) { return (float)(bits >> 8) * 0x1p-24f; }
