/* One ray against one patch of the moving-least-squares surface (PatchBend of shared/octree_types.h);
 * kernels/surface/mls_lanes.cl is the same in vectors.
 * The ray is taken into the patch's frame at its place nearest to the centre, for the roots of a quadratic with far
 * larger terms than the patch would be rounded away. A ray may meet a patch twice. */
#include "lib/vector.cl"
#include "shared/octree_types.h"

/* The roots s at which (x, y, z) + s (dx, dy, dz) meets z = x (xx x + xy y) + yy y y inside x^2 + y^2 <= r2 and
 * |z| <= height, the nearer first; INFINITY for each that there is not, or where `candidate` does not hold. What is divided is
 * never what cancels; NaN of a root below 0, and of a patch along the ray, fails the comparison. `real`: float or a vector;
 * `mask`: its comparisons. */
#define PATCH_ROOTS(real, mask, x, y, z, dx, dy, dz, xx, xy, yy, r2, height, candidate, near_s, far_s)      \
  {                                                                                                         \
    const real a_ = fma(dx, fma(xx, dx, xy * dy), yy * dy * dy);                                            \
    const real b_ = dz - fma(x, fma(2.0f * xx, dx, xy * dy), y * fma(2.0f * yy, dy, xy * dx));              \
    const real c_ = z - fma(x, fma(xx, x, xy * y), yy * y * y);                                             \
    const real w_ = -0.5f * (b_ + copysign(sqrt(fma(b_, b_, 4.0f * a_ * c_)), b_));                         \
    const real s0_ = c_ / w_, s1_ = w_ / -a_;                                                               \
    const real x0_ = fma(s0_, dx, x), y0_ = fma(s0_, dy, y), x1_ = fma(s1_, dx, x), y1_ = fma(s1_, dy, y);  \
    const mask in0_ = candidate & (fma(x0_, x0_, y0_ * y0_) <= r2) & (fabs(fma(s0_, dz, z)) <= height);     \
    const mask in1_ = candidate & (fma(x1_, x1_, y1_ * y1_) <= r2) & (fabs(fma(s1_, dz, z)) <= height);     \
    const real t0_ = select((real)(INFINITY), s0_, in0_), t1_ = select((real)(INFINITY), s1_, in1_);        \
    near_s = min(t0_, t1_);                                                                                 \
    far_s = max(t0_, t1_);                                                                                  \
  }

/* A ray in a patch's frame: from the place nearest to the centre, where t is `t`. */
typedef struct PatchRay {
  float3 u, v;
  float t, x, y, z, dx, dy, dz;
  float near_s, far_s; /* from that place on to where the patch is met; INFINITY: it is not */
} PatchRay;

/* c: the disc's centre and radius, n: its normal, bend: its PatchBend. */
static inline PatchRay patch_ray(float3 o, float3 d, float4 c, float3 n, float4 bend) {
  PatchRay p;
  const float3 to_centre = c.xyz - o;
  p.t = dot3(to_centre, d);
  const float3 off = fma((float3)(p.t), d, -to_centre);
  const float r2 = c.w * c.w;
  p.near_s = p.far_s = INFINITY;
  if (!(dot3(off, off) <= PATCH_REACH2 * r2))
    return p;
  tangents(n, &p.u, &p.v);
  p.x = dot3(p.u, off), p.y = dot3(p.v, off), p.z = dot3(n, off);
  p.dx = dot3(p.u, d), p.dy = dot3(p.v, d), p.dz = dot3(n, d);
  PATCH_ROOTS(float, int, p.x, p.y, p.z, p.dx, p.dy, p.dz, bend.x, bend.y, bend.z, r2, PATCH_HEIGHT * c.w, 1,
              p.near_s, p.far_s)
  return p;
}

/* The patch's unit normal at (x, y), on the side of its disc's. */
static inline float3 patch_normal(float3 n, float3 u, float3 v, float4 bend, float x, float y) {
  const float along_u = fma(2.0f * bend.x, x, bend.y * y), along_v = fma(2.0f * bend.z, y, bend.y * x);
  return (n - along_u * u - along_v * v) / sqrt(fma(along_u, along_u, fma(along_v, along_v, 1.0f)));
}

/* The same at a place near the patch, `off` from the centre; *q is the distance from the disc's axis squared over its radius
 * squared. */
static inline float3 patch_normal_at(float4 c, float3 n, float4 bend, float3 off, float* q) {
  float3 u, v;
  tangents(n, &u, &v);
  const float x = dot3(u, off), y = dot3(v, off);
  *q = fma(x, x, y * y) / (c.w * c.w);
  return patch_normal(n, u, v, bend, x, y);
}
