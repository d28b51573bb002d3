/* One ray against one disc; kernels/surface/disc_lanes.cl is the same in vectors.
 *   FRONTS_ONLY  defined where nearest hits are those of front sides: rays pass through backs */
#include "lib/vector.cl"

/* Whether nearest hits are looked for on the side of a disc that faces a ray; `cosine`, of its normal with the ray, in
 * one lane or several. */
#ifdef FRONTS_ONLY
#define SIDE_COUNTS(cosine) ((cosine) < 0.0f)
#define AND_SIDE_COUNTS(cosine) &SIDE_COUNTS(cosine)
#else
#define SIDE_COUNTS(cosine) true
#define AND_SIDE_COUNTS(cosine)
#endif

/* t at which o + t d meets the plane of the disc (centre c.xyz, normal n), n.(c-o) / n.d (method.md section 6), and the
 * distance there from the centre, squared: inf or NaN for a ray parallel to it. */
static inline float ray_plane(float3 o, float3 d, float4 c, float3 n, float* distance2) {
  const float3 to_centre = c.xyz - o;
  const float t = dot3(n, to_centre) / dot3(n, d);
  const float3 off = fma((float3)(t), d, -to_centre);
  *distance2 = dot3(off, off);
  return t;
}

/* t of the hit of o + t d with the disc (centre c.xyz, radius c.w, normal n), or a value that fails every comparison
 * t > t_min. A ray parallel to the disc misses: inf and NaN fail the comparison of the distance. *q is the distance from
 * the centre squared over the radius squared, in [0, 1] for a hit. */
static inline float meet(float3 o, float3 d, float4 c, float3 n, float* q) {
  float distance2;
  const float t = ray_plane(o, d, c, n, &distance2), r2 = c.w * c.w;
  *q = distance2 / r2;
  return distance2 <= r2 ? t : -INFINITY;
}
