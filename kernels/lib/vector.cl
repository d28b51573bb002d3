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

/* c and s become cosine and sine of 2 pi v, 0 <= v <= 1, within 2e-7; `type`: of all three, float or a vector of floats. The
 * built-in functions reduce angles of any size, which takes PoCL three times as long; a GPU's have fewer registers. For kernels
 * that do little else. About each quarter of the turn these are the polynomials of Moshier's Cephes library for |x| <= pi/4. */
#define COSINE_SINE(type, v, c, s)                                                                             \
  do {                                                                                                         \
    const type turn_quarter = floor(fma((type)(v), (type)(4.0f), (type)(0.5f)));                               \
    const type turn_x = 6.2831853f * fma(turn_quarter, (type)(-0.25f), (type)(v)), turn_x2 = turn_x * turn_x;   \
    const type turn_s = fma(turn_x2 * turn_x,                                                                  \
                            fma(fma((type)(-1.9515295891e-4f), turn_x2, (type)(8.3321608736e-3f)), turn_x2,    \
                                (type)(-1.6666654611e-1f)),                                                    \
                            turn_x);                                                                           \
    const type turn_c = fma(turn_x2 * turn_x2,                                                                 \
                            fma(fma((type)(2.443315711809948e-5f), turn_x2, (type)(-1.388731625493765e-3f)),   \
                                turn_x2, (type)(4.166664568298827e-2f)),                                       \
                            fma((type)(-0.5f), turn_x2, (type)(1.0f)));                                        \
    const type turn_off = fabs(turn_quarter - 2.0f);                                                           \
    const type turn_a = turn_off == 1.0f ? turn_s : turn_c, turn_b = turn_off == 1.0f ? turn_c : turn_s;       \
    c = turn_quarter == 1.0f || turn_quarter == 2.0f ? -turn_a : turn_a;                                       \
    s = turn_quarter == 2.0f || turn_quarter == 3.0f ? -turn_b : turn_b;                                       \
  } while (0)

/* Two unit vectors across the unit vector n (Duff et al. 2017, "Building an orthonormal basis, revisited"). */
static inline void tangents(float3 n, float3* u, float3* v) {
  const float s = copysign(1.0f, n.z), a = -1.0f / (s + n.z), b = n.x * n.y * a;
  *u = (float3)(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
  *v = (float3)(b, s + n.y * n.y * a, -n.y);
}
