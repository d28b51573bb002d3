/* Splats that shine: area lights. Light from far is sampled on them; of what is near, where such an estimate grows as
 * 1/d^2, rays by the cosine find a part, and the two share by the balance heuristic: no estimate is above pi times the brightest L. */
#include "lights/light_sample.cl"

/* Whether a surface may be nearer to an emitting splat than RenderParams::emitter_reach: where the density of light samples
 * falls below that of the cosine. */
static inline bool is_near_emitters(const Surface* s, __constant RenderParams* params) {
  const float3 low = load3_constant(params->emitter_low), high = load3_constant(params->emitter_high);
  const float3 off = s->position - clamp(s->position, low, high);
  return dot3(off, off) < params->emitter_reach * params->emitter_reach;
}

/* One emitting splat in proportion to its power, one point on the disc of its effective area: H = L A cos cos' / (d^2 p);
 * nearer than `reach` diffuse_weight is what rays by the cosine leave of it. False where the light does not reach the surface's front whatever stands between. */
static inline bool sample_emitter(POOL_PARAMS, const Surface* s, const __global Material* materials,
                                  const __global Emitter* emitters, uint emitter_count, float reach, float4 u,
                                  LightSample* sample) {
  const uint i = pick(&emitters->cumulative, sizeof(Emitter) / sizeof(float), emitter_count, u.x);
  const float share = emitters[i].cumulative - (i > 0u ? emitters[i - 1u].cumulative : 0.0f);
  const uint point = emitters[i].point;
  const float4 centre = pool_point_texel(POINT_TEXELS * point);
  const float4 normal = pool_point_texel(POINT_TEXELS * point + 1u);
  const float area = pool_point_texel(POINT_TEXELS * point + 2u).w;
  float3 a, b;
  tangents(normal.xyz, &a, &b);
  const float r = sqrt(u.z * area * 0.31830989f), phi = 6.2831853f * u.w;
  float3 off = r * cos(phi) * a + r * sin(phi) * b;
#ifdef HAS_CLIPS
  off = fold_into_clip(&emitters[i].clip, off);
#endif
  float3 towards = centre.xyz + off - s->position;
  /* Not nearer than a tenth of the disc: the estimate of a light that touches the surface stays finite. */
  const float exact2 = dot3(towards, towards), d2 = fmax(exact2, 0.01f * area);
  sample->distance = sqrt(d2);
  towards /= sample->distance;
  const float cosine = dot3(s->normal, towards), cosine_at_light = -dot3(normal.xyz, towards);
  const __global Material* material = materials + (uint)normal.w;
  sample->towards = towards;
  sample->irradiance = load3(material->emission) * (area * cosine * cosine_at_light / (d2 * share));
  if (exact2 < reach * reach)
    sample->diffuse_weight = mis_weight(material->emitter_density * exact2 / fmax(cosine_at_light, 1e-6f), INVERSE_PI * cosine);
  sample->normal = normal.xyz;
  sample->radius = centre.w;
#ifdef HAS_LOBES
  sample->pdf = material->emitter_density * exact2 / cosine_at_light;
#endif
  return share > 0.0f && cosine > 0.0f && cosine_at_light > 0.0f &&
         !is_own_far_side(s->normal, s->radius, towards, sample->distance, centre.w, normal);
}

/* Density, per solid angle, with which sample_emitter finds the place of an emitter that a ray has met. Overlapping discs of
 * one material are sampled as if they were one surface of even density. */
static inline float emitter_pdf(const Surface* s, const __global Material* materials, float3 direction) {
  const float cosine = fabs(dot3(s->normal, direction));
  return materials[s->material].emitter_density * s->t * s->t / fmax(cosine, 1e-6f);
}

/* Irradiance by one ray drawn by the cosine: what it meets that shines, nearer than RenderParams::emitter_reach, by the
 * balance heuristic. `u`: two numbers in [0,1). */
static inline float3 near_emitter(POOL_PARAMS, const Surface* s, const __global Material* materials,
                                  __constant RenderParams* params, float2 u, float* rays) {
  Ray ray;
  ray.origin = s->position;
  ray.direction = cosine_direction(s->normal, u.x, u.y);
  ray.t_min = -SEGMENT_MARGIN(s->radius);
  ray.t_max = params->emitter_reach;
#ifdef STEP_ABSOLUTE
  ray.step_delta = params->step_delta;
#endif
  OcclusionEnds ends = free_ends();
  ends.origin_normal = s->normal;
  ends.origin_radius = s->radius;
  *rays += 1.0f;
  const Hit hit = trace_closest_from(POOL_ARGS, ray, ends);
  if (hit.splat == NO_SPLAT)
    return (float3)(0.0f);
  const float4 normal = normal_at_hit(POOL_ARGS, ray, hit.t, hit.splat);
  const __global Material* material = materials + (uint)normal.w;
  const float cosine_at_light = -dot3(normal.xyz, ray.direction);
  if (cosine_at_light <= 0.0f || material->emitter_density <= 0.0f)
    return (float3)(0.0f);
  const float pdf = material->emitter_density * hit.t * hit.t / fmax(cosine_at_light, 1e-6f);
  return load3(material->emission) * (mis_weight(INVERSE_PI * dot3(s->normal, ray.direction), pdf) / INVERSE_PI);
}
