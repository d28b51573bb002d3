/* Vector helpers whose rounding does not depend on what the compiler likes to contract: every fused product is written
 * as fma(), and contraction of the rest is off. The host twins do the same, so CPU devices agree with them bit for bit. */
#pragma OPENCL FP_CONTRACT OFF
#include "shared/scalar.h"

/* Before a kernel whose work-items diverge or are written in vectors: a compiler that packs work-items into the lanes of vectors
 * leaves these alone. Intel's CPU runtime packs 8 or 16, and was 2 to 100 times slower for it; other compilers ignore the hint. */
#define OWN_VECTORS __attribute__((vec_type_hint(float8)))

static inline float dot3(float3 a, float3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

static inline float3 load3(const __global float* p) { return (float3)(p[0], p[1], p[2]); }
static inline float3 load3_constant(const __constant float* p) { return (float3)(p[0], p[1], p[2]); }

static inline float3 normalize3(float3 v) { return v / sqrt(dot3(v, v)); }

/* Two unit vectors across the unit vector n (Duff et al. 2017, "Building an orthonormal basis, revisited"). */
static inline void tangents(float3 n, float3* u, float3* v) {
  const float s = copysign(1.0f, n.z), a = -1.0f / (s + n.z), b = n.x * n.y * a;
  *u = (float3)(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
  *v = (float3)(b, s + n.y * n.y * a, -n.y);
}
