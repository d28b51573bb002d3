/* Rims of discs that are no part of the surface. Where a surface bends away from the viewer, rims of discs from behind its
 * horizon stick out, and a ray meets their backs although the surface has none there. The middle of such a disc is hidden
 * behind a front side close before it, its own surface's; that of a disc on the inside of an open surface is not. */
#include "lib/ray.cl"
#include "surface/disc.cl"

/* How close, in units of the two discs' radii: across what is thin, an ear or a hoof, but not across a vessel. */
#define RIM_REACH 8.0f

/* Whether the ray meets the back of the splat with this normal. */
static inline bool is_back(float3 normal, float3 direction) { return !(dot3(normal, direction) < 0.0f); }

/* The ray that says whether the back of the disc `centre`, which `ray` meets, is such a rim: to the disc's middle, *distance
 * away. */
static inline Ray rim_ray(Ray ray, float4 centre, float* distance) {
  ray.direction = centre.xyz - ray.origin;
  *distance = sqrt(dot3(ray.direction, ray.direction));
  ray.direction /= *distance;
  ray.t_max = *distance - 0.05f * centre.w; /* what passes through the middle itself hides nothing */
  return ray;
}

/* Whether the disc (`hidden_by`, `normal`) that the ray to the middle meets at t hides the middle, of radius `radius`. */
static inline bool hides_rim(float3 direction, float distance, float radius, float t, float4 hidden_by, float3 normal) {
  return !is_back(normal, direction) && distance - t < RIM_REACH * (radius + hidden_by.w);
}
