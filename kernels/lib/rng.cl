/* Counter-based random numbers: a value is a function of (seed, pixel, sample, dimension), so the picture does not
 * depend on tiles, threads or the order of launches. */

/* The pcg4d hash of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020. */
static inline uint4 pcg4d(uint4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

/* Uniform in [0, 1): 24 bits, so that the largest value stays below 1 in float. */
static inline float unit_float(uint bits) { return (float)(bits >> 8) * 0x1p-24f; }
