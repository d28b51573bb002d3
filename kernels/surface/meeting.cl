/* Where one ray meets one splat, whatever the form of the surface.
 *   HAS_MLS  splats are patches of the moving-least-squares surface (kernels/surface/mls.cl), else discs */
#include "lib/pools.cl"
#include "lib/ray.cl"
#include "surface/disc.cl"
#include "surface/mls.cl"

typedef struct Meeting {
  float t;       /* fails every comparison t > t_min where the ray misses */
  float q;       /* distance from the splat's axis squared over its radius squared, in [0, 1] */
  float4 normal; /* the surface's there, unit; w: the splat's material */
} Meeting;

/* Runs `body` for each `m` of the ray o + t d with a splat, nearest first: of a disc for the only one, met or not, of a patch
 * for those that there are. centre, normal and bend: the splat's texels. */
#ifdef HAS_MLS
static inline Meeting patch_meeting(const PatchRay* p, float s, float4 centre, float4 normal, float4 bend) {
  Meeting m;
  const float x = fma(s, p->dx, p->x), y = fma(s, p->dy, p->y);
  m.t = p->t + s;
  m.q = fma(x, x, y * y) / (centre.w * centre.w);
  m.normal = (float4)(patch_normal(normal.xyz, p->u, p->v, bend, x, y), normal.w);
  return m;
}
#define FOR_MEETINGS(m, o, d, centre, normal, bend, body)                          \
  {                                                                                \
    const PatchRay patch_ = patch_ray(o, d, centre, (normal).xyz, bend);           \
    for (float s_ = patch_.near_s, next_ = patch_.far_s; s_ < INFINITY; s_ = next_, next_ = INFINITY) { \
      const Meeting m = patch_meeting(&patch_, s_, centre, normal, bend);          \
      body                                                                         \
    }                                                                              \
  }
#else
#define FOR_MEETINGS(m, o, d, centre, of_disc, bend, body)             \
  {                                                                    \
    Meeting m;                                                         \
    m.normal = of_disc;                                                \
    m.t = meet(o, d, centre, m.normal.xyz, &m.q);                      \
    body                                                               \
  }
#endif

/* The surface's normal at a hit, unit; w: the splat's material. */
static inline float4 normal_at_hit(POOL_PARAMS, Ray ray, float t, uint splat) {
  const float4 normal = pool_point_texel(POINT_TEXELS * splat + 1u);
#ifdef HAS_MLS
  const float4 centre = pool_point_texel(POINT_TEXELS * splat);
  float q;
  return (float4)(patch_normal_at(centre, normal.xyz, pool_bend(splat), fma((float3)(t), ray.direction, ray.origin - centre.xyz), &q),
                  normal.w);
#else
  return normal;
#endif
}
