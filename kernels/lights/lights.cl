/* Light that reaches a surface straight from its source, by shadow rays: the kinds of light that are compiled in.
 *   HAS_LIGHT_SOURCES  the scene has a [[light]]
 *   WITH_LIGHT_<ID>   of each kind of shared/light_kinds.h, where HAS_LIGHT_SOURCES: 1 where the scene has it, else 0
 *   HAS_LIGHT_DISCS   one of them has a size (SIZED_LIGHTS)
 *   HAS_EMITTERS      some splats may shine
 *   HAS_ENVIRONMENT   the environment may shine
 *   HAS_SKY_MAP       it is a map
 *   HAS_STORED_DIRECT the points hold what is known of it (kernels/lib/pools.cl); not where points are shaded themselves
 * On CPU devices these stand only where the scene has such lights; other devices have few programs for all scenes. */
#include "lights/directional.cl"
#include "lights/emitter.cl"
#include "lights/point.cl"
#include "lights/sky.cl"
#include "lights/sun.cl"
#include "materials/materials.cl"

/* Use of random numbers at a vertex beside 1 to 3 for the kinds of light and those of kernels/render/eye_sample.cl (4 to 6). */
#define DIMENSION_SECOND_SKY 7u
/* Another seed for the rays that look for emitters near by: all dimensions of a vertex are in use. */
#define NEAR_EMITTER_SEED 0x51ED270Bu

/* The surface that is lit, as its viewer sees it: what the lobe of its material needs. */
typedef struct Viewed {
  float3 direction;           /* of the ray that has met the surface */
  float specular_probability; /* with which that ray goes on by the lobe */
} Viewed;

static inline Viewed viewed_by(float3 direction, float specular_probability) {
  const Viewed viewed = {direction, specular_probability};
  return viewed;
}

/* Rays off a surface start a little behind it: where two walls meet, rounding may put the point a few float steps beyond
 * the other wall, and light would leak in along the edge. The surface itself does not count (OcclusionEnds). */
#define BEHIND_SURFACE(radius) (-SEGMENT_MARGIN(radius))

/* Whether nothing stands between the surface and the light; counts its ray. */
static inline bool in_light(POOL_PARAMS, const Surface* s, const LightSample* light, float step_delta, float* rays) {
  Ray ray;
  ray.origin = s->position;
  ray.direction = light->towards;
  ray.t_min = BEHIND_SURFACE(s->radius);
  ray.t_max = light->distance;
#ifdef STEP_ABSOLUTE
  ray.step_delta = step_delta;
#endif
  const OcclusionEnds ends = {s->normal, light->normal, s->radius, light->radius};
  *rays += 1.0f;
  return !trace_any(POOL_ARGS, ray, ends);
}

#ifdef HAS_LIGHT_SOURCES
/* FOR_LIGHT_1(ID, name) is the code of a kind that is compiled in, FOR_LIGHT_0 that of one that is not. */
#define FOR_LIGHT(with, ID, name) FOR_LIGHT_(with, ID, name)
#define FOR_LIGHT_(with, ID, name) FOR_LIGHT_##with(ID, name)
#define FOR_LIGHT_0(ID, name)
#define SAMPLE_LIGHT(ID, name) FOR_LIGHT(WITH_LIGHT_##ID, ID, name)

/* One [[light]]: number i, or where there are more than ALL_LIGHT_SOURCES one that is drawn. False where the light does not
 * reach the surface's front whatever stands between. */
static inline bool sample_light_source(const Surface* s, Lights lights, float4 u, uint i, LightSample* sample) {
  const uint count = lights.params->light_sources;
  float share = 1.0f;
  if (count > ALL_LIGHT_SOURCES) {
    i = pick(&lights.light_sources->cumulative, sizeof(LightSource) / sizeof(float), count, u.x);
    share = lights.light_sources[i].cumulative - (i > 0u ? lights.light_sources[i - 1u].cumulative : 0.0f);
  }
  const __global LightSource* light = lights.light_sources + i;
  const float2 place = count > ALL_LIGHT_SOURCES ? u.zw : u.xy; /* what has not chosen the light is stratified */
  float falloff = 0.0f, pdf = 0.0f;
  sample->towards = s->normal;
  sample->distance = INFINITY;
#define FOR_LIGHT_1(ID, name)     \
  if (light->type == LIGHT_##ID) \
    falloff = name##_sample(light, s->position, place, &sample->towards, &sample->distance, &pdf);
  LIGHT_KINDS(SAMPLE_LIGHT)
#undef FOR_LIGHT_1
  const float cosine = dot3(s->normal, sample->towards);
  sample->irradiance = load3(light->strength) * (cosine * falloff) / share;
  sample->normal = (float3)(0.0f);
  sample->radius = 0.0f;
#ifdef HAS_LOBES
  sample->pdf = share * pdf;
#endif
  return cosine > 0.0f;
}

/* Where a photon of the light sets out. */
static inline PhotonOrigin emit_from_light(const __global LightSource* light, float2 u) {
  PhotonOrigin origin = {(float3)(0.0f), true, (float3)(0.0f)};
#define FOR_LIGHT_1(ID, name)     \
  if (light->type == LIGHT_##ID) \
    origin = name##_emit(light, u);
  LIGHT_KINDS(SAMPLE_LIGHT)
#undef FOR_LIGHT_1
  return origin;
}
#endif

#ifdef HAS_LIGHT_DISCS
/* Radiance of [[light]] i along a ray that meets nothing, and the density with which sample_light_source draws its direction. */
static inline float3 light_towards(Lights lights, uint i, float3 direction, float* pdf) {
  const __global LightSource* light = lights.light_sources + i;
  float factor = 0.0f;
  *pdf = 0.0f;
#define FOR_LIGHT_1(ID, name)     \
  if (light->type == LIGHT_##ID) \
    factor = name##_towards(light, direction, pdf);
  SIZED_LIGHT_KINDS(SAMPLE_LIGHT)
#undef FOR_LIGHT_1
  if (lights.params->light_sources > ALL_LIGHT_SOURCES)
    *pdf *= light->cumulative - (i > 0u ? lights.light_sources[i - 1u].cumulative : 0.0f);
  return load3(light->strength) * factor;
}
#endif

/* Shares of discs that all know their lights add up to 1 but for rounding. */
#define ALL_STORED 0.9999f

/* What is left for rays: shares of the light of [[light]]s and emitting splats, and of the sky. */
typedef struct ByRays {
  float of_sources, of_sky;
} ByRays;

static inline ByRays left_for_rays(const Surface* s, Lights lights) {
  ByRays left = {1.0f, 1.0f};
#ifdef HAS_STORED_DIRECT
  left.of_sources = s->direct.w < ALL_STORED ? 1.0f - s->direct.w : 0.0f;
  left.of_sky = lights.params->sky_at_points != 0u ? 0.0f : 1.0f;
#endif
  return left;
}

/* Whether some light has to be sampled for what the surface's lobe makes of it. */
static inline bool has_highlight(const Surface* s, Lights lights) {
#ifdef HAS_LOBES
  return has_flag(lights.materials + s->material, MATERIAL_HAS_LOBE);
#else
  return false;
#endif
}

/* Irradiance H [W/m2, scaled] of the surface from all lights, one estimate; the mean over samples converges to it.
 * Adds the number of shadow rays traced to *rays. One place traces them all: the walk stands once in the code, and
 * work-items that shade different lights walk together. Where the surface has a lobe, s->highlight becomes the radiance that
 * the lobe makes of the lights; a light that rays of the lobe may meet themselves counts by its MIS weight (seen_light). */
static inline float3 direct_irradiance(POOL_PARAMS, Surface* s, Lights lights, SampleId id, Viewed viewed, float* rays) {
  float3 sum = (float3)(0.0f);
  uint source_samples = 0u, emitter_samples = 0u, environment_samples = 0u;
  const ByRays left = left_for_rays(s, lights);
#ifdef HAS_STORED_DIRECT
  sum = s->direct.xyz;
  const bool asks_sources = left.of_sources > 0.0f || has_highlight(s, lights);
  const bool asks_sky = left.of_sky > 0.0f || has_highlight(s, lights);
#else
  const bool asks_sources = true, asks_sky = true;
#endif
#ifdef HAS_LOBES
  s->highlight = (float3)(0.0f);
#endif
#ifdef HAS_LIGHT_SOURCES
  if (asks_sources)
    source_samples = lights.params->light_sources <= ALL_LIGHT_SOURCES ? lights.params->light_sources : 1u;
#endif
#ifdef HAS_EMITTERS
  emitter_samples = lights.params->emitters > 0u && asks_sources ? 1u : 0u;
  const float reach = emitter_samples > 0u && is_near_emitters(s, lights.params) ? lights.params->emitter_reach : 0.0f;
#endif
#ifdef HAS_ENVIRONMENT
  const float3 sky = load3_constant(lights.params->environment);
  environment_samples = asks_sky && (sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f) ? SKY_SAMPLES : 0u;
#endif
  for (uint i = 0u; i < source_samples + emitter_samples + environment_samples; ++i) {
#if defined(HAS_ENVIRONMENT) && defined(HAS_SKY_MAP)
    const uint second = source_samples + emitter_samples + 1u; /* of the map's two samples */
    const float4 u = stratified4(id, i == second ? DIMENSION_SECOND_SKY : i < source_samples ? 1u : i + 1u < second ? 2u : 3u);
#else
    const float4 u = stratified4(id, i < source_samples ? 1u : i < source_samples + emitter_samples ? 2u : 3u);
#endif
    LightSample light;
    bool faces = false;
    light.diffuse_weight = 1.0f;
#ifdef HAS_LIGHT_SOURCES
    if (i < source_samples)
      faces = sample_light_source(s, lights, u, i, &light);
#endif
#ifdef HAS_EMITTERS
    if (i >= source_samples && i < source_samples + emitter_samples)
      faces = sample_emitter(POOL_ARGS, s, lights.materials, lights.emitters, lights.params->emitters, reach, u,
                             &light);
#endif
#ifdef HAS_ENVIRONMENT
    if (i >= source_samples + emitter_samples)
      faces = sample_sky(s, lights, u, i - source_samples - emitter_samples, &light);
#endif
    if (faces && in_light(POOL_ARGS, s, &light, lights.params->step_delta, rays)) {
      sum += light.diffuse_weight * light.irradiance *
             (i < source_samples + emitter_samples ? left.of_sources : left.of_sky);
#ifdef HAS_LOBES
      const __global Material* material = lights.materials + s->material;
      if (has_flag(material, MATERIAL_HAS_LOBE)) {
        float pdf;
        const float3 f = eval_lobe(s, material, viewed.direction, light.towards, &pdf);
        pdf *= viewed.specular_probability;
        s->highlight += light.irradiance * f * (light.pdf > 0.0f ? mis_weight(light.pdf, pdf) : 1.0f);
      }
#endif
    }
  }
#ifdef HAS_EMITTERS
  if (reach > 0.0f) {
    SampleId near = id;
    near.seed ^= NEAR_EMITTER_SEED;
    sum += left.of_sources *
           near_emitter(POOL_ARGS, s, lights.materials, lights.params, stratified4(near, 2u).xy, rays);
  }
#endif
  return sum;
}
