/* Overlapping discs, or patches, near the first hit become one smooth surface: colour, normal and depth are means with a
 * weight that falls to zero at a disc's rim, or seams would show (method.md section 6). Colour and the light that is stored with the
 * points are means over the discs of the first one's material alone: those of a mirror or a lamp are black, and would
 * darken what is beside it. */
#include "lib/pools.cl"
#include "lib/ray.cl"
#include "surface/disc.cl"
#include "surface/meeting.cl"

/* A bent surface's discs are clipped where they would stick out of it (host/cloud/disc_borders.h): they are not met there,
 * and their colour, light and normal reach as far as ever, or their borders would show. A flat disc's do end. */
#ifdef HAS_CLIPS
#define BLEND_BEGIN(blend) (blend)->t_begin
#else
#define BLEND_BEGIN(blend) (blend)->t_first
#endif

/* How far behind the first hit a disc still belongs to the same surface, in radii of the disc hit first. Overlapping
 * neighbours of a curved or noisy surface lie less than a radius apart along the ray. */
#ifndef BLEND_DEPTH
#define BLEND_DEPTH 1.0f
#endif
#define BLEND_COSINE 0.5f /* discs that face another way by 60 degrees are of another surface: a corner stays sharp */

typedef struct Surface {
  float3 position, normal, albedo; /* normal on the splats' front side, unit */
#ifdef HAS_RADIOSITY
  float3 irradiance; /* from other surfaces */
#endif
#ifdef HAS_STORED_DIRECT
  float4 direct; /* direct_pool's */
#endif
#ifdef HAS_CAUSTICS
  float4 caustic; /* caustic_pool's */
#endif
  float t;
  float radius;  /* of the disc hit first */
  uint splat;    /* the disc hit first */
  uint material; /* its material */
  bool front;    /* the ray met the front side */
#ifdef HAS_LOBES
  float3 highlight; /* see direct_irradiance */
#endif
} Surface;

typedef struct Blend {
  float3 normal_of_first;
  float3 normal, albedo; /* weighted sums, as are irradiance, direct, caustic and t */
#ifdef HAS_RADIOSITY
  float3 irradiance;
#endif
#ifdef HAS_STORED_DIRECT
  float4 direct;
#endif
#ifdef HAS_CAUSTICS
  float4 caustic;
#endif
  float t, weight;          /* `weight`: of normal and t */
  float weight_of_material; /* of albedo, irradiance, direct and caustic */
  float t_first, t_end; /* discs hit in [t_first, t_end) count */
#ifdef HAS_CLIPS
  float t_begin; /* what is clipped off a disc counts from here on */
#endif
  float radius;
  uint splat, material;
#ifdef HAS_CLIPS
  bool flat; /* the disc hit first is */
#endif
} Blend;

#if defined(HAS_SPECULAR) && !defined(HAS_MLS) /* the normals of patches change of themselves */
#define FIELD_NORMALS
#endif

#ifdef FIELD_NORMALS
/* A splat's own normal changes over its disc (method.md section 6). */
static inline float3 field_normal(POOL_PARAMS, Ray ray, uint splat, float t, float3 normal) {
  const float4 f = field_pool[splat];
  const float3 off = fma((float3)(t), ray.direction, ray.origin - pool_point_texel(POINT_TEXELS * splat).xyz);
  float3 a, b;
  tangents(normal, &a, &b);
  const float u = dot3(off, a), v = dot3(off, b);
  return normalize3(normal + (u * f.x + v * f.z) * a + (u * f.y + v * f.w) * b);
}
#endif

static inline void blend_add(POOL_PARAMS, Blend* b, Ray ray, uint splat, Meeting m, float3 albedo) {
  float3 normal = m.normal.xyz;
  if (dot3(normal, b->normal_of_first) <= BLEND_COSINE)
    return;
  const float behind = fabs(m.t - b->t_first); /* in front is what was clipped off */
#ifdef HAS_CLIPS
  /* Of two discs of which one is flat, the one behind the other is another surface. */
  if ((b->flat || IS_FLAT(m.normal.w)) && behind * fabs(dot3(normal, ray.direction)) > FLAT_HEIGHT)
    return;
#endif
  /* A tiny floor keeps a lone disc visible out to its very rim. */
  const float rim = fmax(1.0f - m.q, 1e-3f);
  const float depth = 1.0f - behind / (b->t_end - b->t_first);
  const float w = rim * rim * depth, of_material = (uint)m.normal.w == b->material ? w : 0.0f;
  b->weight += w;
  b->weight_of_material += of_material;
#ifdef FIELD_NORMALS
  normal = field_normal(POOL_ARGS, ray, splat, m.t, normal);
#endif
  b->normal += w * normal;
  b->albedo += of_material * albedo;
#ifdef HAS_RADIOSITY
  b->irradiance += of_material * irradiance_pool[splat].xyz;
#endif
#ifdef HAS_STORED_DIRECT
  const float4 known = direct_pool[2u * splat];
  const float3 off = fma((float3)(m.t), ray.direction, ray.origin - pool_point_texel(POINT_TEXELS * splat).xyz);
  const float change = fmax(1.0f + dot3(direct_pool[2u * splat + 1u].xyz, off), 0.0f);
  b->direct += of_material * (float4)(change * known.xyz, known.w);
#endif
#ifdef HAS_CAUSTICS
  b->caustic += of_material * caustic_pool[splat];
#endif
  b->t += w * m.t;
}

/* Begins with the splat hit first, `first`; the caller adds the others. */
static inline void blend_begin(POOL_PARAMS, Blend* b, Ray ray, Hit first) {
  const float4 centre = pool_point_texel(POINT_TEXELS * first.splat);
  Meeting m;
  m.normal = pool_point_texel(POINT_TEXELS * first.splat + 1u);
  /* No second judgement of whether the ray meets the splat: one that went on from a surface before it (hit_behind) did so
   * from another origin, and at the very rim rounding may tell the two apart. */
#ifdef HAS_MLS
  m.t = first.t;
  m.normal.xyz = patch_normal_at(centre, m.normal.xyz, pool_bend(first.splat),
                                 fma((float3)(m.t), ray.direction, ray.origin - centre.xyz), &m.q);
  m.q = fmin(m.q, 1.0f);
#else
  float distance2;
  m.t = ray_plane(ray.origin, ray.direction, centre, m.normal.xyz, &distance2);
  m.q = fmin(distance2 / (centre.w * centre.w), 1.0f);
#endif
  b->normal_of_first = m.normal.xyz;
  b->normal = b->albedo = (float3)(0.0f);
#ifdef HAS_RADIOSITY
  b->irradiance = (float3)(0.0f);
#endif
#ifdef HAS_STORED_DIRECT
  b->direct = (float4)(0.0f);
#endif
#ifdef HAS_CAUSTICS
  b->caustic = (float4)(0.0f);
#endif
  b->weight = b->weight_of_material = b->t = 0.0f;
  b->t_first = m.t;
  /* At least a few float steps, so that the window is never empty. */
  b->t_end = m.t + fmax(BLEND_DEPTH * centre.w, 1e-6f * m.t);
  b->radius = centre.w;
  b->splat = first.splat;
  b->material = (uint)m.normal.w;
#ifdef HAS_CLIPS
  b->flat = IS_FLAT(m.normal.w);
  b->t_begin = fmax(ray.t_min, m.t - (b->t_end - m.t));
#endif
  blend_add(POOL_ARGS, b, ray, first.splat, m, pool_point_texel(POINT_TEXELS * first.splat + 2u).xyz);
}

static inline void blend_end(const Blend* b, Ray ray, Surface* s) {
  const float scale = 1.0f / b->weight, scale_of_material = 1.0f / b->weight_of_material;
  s->t = b->t * scale;
  s->position = fma((float3)(s->t), ray.direction, ray.origin);
  s->normal = normalize3(b->normal);
  s->albedo = b->albedo * scale_of_material;
#ifdef HAS_RADIOSITY
  s->irradiance = b->irradiance * scale_of_material;
#endif
#ifdef HAS_STORED_DIRECT
  s->direct = b->direct * scale_of_material;
#endif
#ifdef HAS_CAUSTICS
  s->caustic = b->caustic * scale_of_material;
#endif
  s->radius = b->radius;
  s->splat = b->splat;
  s->material = b->material;
  s->front = dot3(b->normal_of_first, ray.direction) < 0.0f;
}
