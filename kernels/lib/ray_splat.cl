/* One ray against one disc. */
#include "lib/vector.cl"

/* t of the hit of o + t d with the disc (centre c.xyz, radius c.w, normal n), or a value that fails every comparison
 * t > t_min: t = n.(c-o) / n.d, inside where |o + t d - c| <= r (method.md section 6). A ray parallel to the disc
 * divides by zero and misses: inf and NaN fail the comparison of the distance. *q is the distance from the centre
 * squared over the radius squared, in [0, 1] for a hit. */
static inline float ray_disc(float3 o, float3 d, float4 c, float3 n, float* q) {
  const float3 to_centre = c.xyz - o;
  const float t = dot3(n, to_centre) / dot3(n, d);
  const float3 off = fma((float3)(t), d, -to_centre);
  const float distance2 = dot3(off, off), r2 = c.w * c.w;
  *q = distance2 / r2;
  return distance2 <= r2 ? t : -INFINITY;
}
