/* Photons on their way from a light to a specular leaf (method.md section 5).
 *   EQUAL_POWER  defined: to a random point of a splat of the leaf, each with the same power, as in the thesis; else
 *                uniformly over the leaf's sphere, with the power that makes their sum unbiased */
#include "lights/lights.cl"
#include "shared/photon_types.h"

/* Uses of random numbers at vertex 0 (kernels/lib/sampling.cl). */
#define DIMENSION_TARGET 1u
#define DIMENSION_ORIGIN 2u

/* What photons are made from. */
typedef struct PhotonSource {
  Lights lights;
  const __global float4* radiance; /* of each emitter's front */
  const __global PhotonLeaf* leaves;
  const __global uint* leaf_splats;
} PhotonSource;

typedef struct Emission {
  Ray ray;
  OcclusionEnds ends; /* of the surface that it leaves, or free */
  float3 power;
} Emission;

/* Two numbers in [0,1) for photon `number` of the batch's: one stratum each of the first, and van der Corput's sequence, turned
 * by a random number of the batch, for the second. */
static inline float2 stratified2(const __global EmissionBatch* batch, uint number, SampleId id) {
  uint reversed = number;
  reversed = ((reversed & 0x55555555u) << 1) | ((reversed >> 1) & 0x55555555u);
  reversed = ((reversed & 0x33333333u) << 2) | ((reversed >> 2) & 0x33333333u);
  reversed = ((reversed & 0x0f0f0f0fu) << 4) | ((reversed >> 4) & 0x0f0f0f0fu);
  reversed = ((reversed & 0x00ff00ffu) << 8) | ((reversed >> 8) & 0x00ff00ffu);
  reversed = (reversed << 16) | (reversed >> 16);
  const uint turn = pcg4d((uint4)(batch->first, batch->leaf, 0x2545F491u, id.seed)).x;
  const float u = ((float)number + random4(id, DIMENSION_TARGET).x) / (float)batch->count;
  return (float2)(fmin(u, 0.99999994f), unit_float(reversed + turn));
}

/* A point of the disc about the origin across `axis`. */
static inline float3 disc_point(float3 axis, float radius, float u, float v) {
  float3 a, b;
  tangents(axis, &a, &b);
  const float r = radius * sqrt(u), phi = 6.2831853f * v;
  return r * cos(phi) * a + r * sin(phi) * b;
}

/* Parallel light starts outside the root cube. */
#define OUTSIDE 1.8f

/* A point of the emitting splats, and its part in them: position, normal, what it sends into a unit of solid angle along its
 * normal. */
static inline float3 emitter_point(POOL_PARAMS, PhotonSource from, float4 u, Emission* e) {
  const uint i = pick(&from.lights.emitters->cumulative, sizeof(Emitter) / sizeof(float), from.lights.params->emitters, u.x);
  const float share = from.lights.emitters[i].cumulative - (i > 0u ? from.lights.emitters[i - 1u].cumulative : 0.0f);
  const uint point = from.lights.emitters[i].point;
  const float4 centre = pool_point_texel(POINT_TEXELS * point), normal = pool_point_texel(POINT_TEXELS * point + 1u);
  const float area = pool_point_texel(POINT_TEXELS * point + 2u).w;
  e->ends.origin_normal = normal.xyz;
  e->ends.origin_radius = centre.w;
  e->power = share > 0.0f ? from.radiance[i].xyz * (area / share) : (float3)(0.0f);
  float3 off = disc_point(normal.xyz, sqrt(area * 0.31830989f), u.z, u.w);
#ifdef HAS_CLIPS
  off = fold_into_clip(&from.lights.emitters[i].clip, off);
#endif
  return centre.xyz + off;
}

static inline float luminance_of(float3 c) { return dot3(c, (float3)(0.2126f, 0.7152f, 0.0722f)); }

#ifdef EQUAL_POWER
/* The point that photon `number` of the batch flies to: all splats of the leaf have as many, those left over at random. */
static inline float3 equal_target(POOL_PARAMS, PhotonSource from, const __global EmissionBatch* batch, uint number, SampleId id) {
  const __global PhotonLeaf* leaf = from.leaves + batch->leaf;
  const float4 u = random4(id, DIMENSION_TARGET);
  const uint whole = batch->count - batch->count % leaf->count;
  const uint k = number < whole ? number % leaf->count : min((uint)(u.x * (float)leaf->count), leaf->count - 1u);
  const uint splat = from.leaf_splats[leaf->first + k];
  const float4 centre = pool_point_texel(POINT_TEXELS * splat);
  return centre.xyz + disc_point(pool_point_texel(POINT_TEXELS * splat + 1u).xyz, centre.w, u.z, u.w);
}
#endif

/* Photon `number` of the batch's. */
static inline Emission emit_photon(POOL_PARAMS, PhotonSource from, const __global EmissionBatch* batch, uint number, SampleId id) {
  Emission e;
  e.ends = free_ends();
  e.ray.t_min = 0.0f;
  e.ray.t_max = INFINITY;
#ifdef STEP_ABSOLUTE
  e.ray.step_delta = from.lights.params->step_delta;
#endif
  const __global PhotonLeaf* leaf = from.leaves + batch->leaf;
  const float4 u = random4(id, DIMENSION_ORIGIN);
  bool parallel = batch->source == SOURCE_ENVIRONMENT;
  float3 colour = (float3)(0.0f), origin = (float3)(0.0f), towards = (float3)(0.0f, 0.0f, 1.0f);
  float solid_angle = 1.0f;
  if (batch->source < SOURCE_ENVIRONMENT) {
#ifdef HAS_LIGHT_SOURCES
    const PhotonOrigin of_light = emit_from_light(from.lights.light_sources + batch->source, u.xy);
    colour = of_light.strength;
    parallel = of_light.parallel;
    origin = of_light.vector;
    towards = origin;
#endif
  } else if (batch->source == SOURCE_EMITTERS) {
    origin = emitter_point(POOL_ARGS, from, u, &e);
    colour = e.power;
    e.ray.t_min = BEHIND_SURFACE(e.ends.origin_radius);
  } else {
#ifdef HAS_SKY_MAP
    const float4 texel = sky_map_sample(from.lights.sky, u, &towards);
    colour = texel.xyz;
    solid_angle = 1.0f / texel.w;
#else
    colour = load3_constant(from.lights.params->environment);
    towards = cone_direction(towards, 1.0f, u.xy, &solid_angle);
#endif
  }
#ifdef EQUAL_POWER
  const float3 target = equal_target(POOL_ARGS, from, batch, number, id);
  const float luminance = luminance_of(colour);
  e.power = luminance > 0.0f ? colour * (batch->share / luminance) : (float3)(0.0f);
  e.ray.origin = parallel ? target + OUTSIDE * towards : origin;
  e.ray.direction = normalize3(target - e.ray.origin);
#else
  const float2 v = stratified2(batch, number, id);
  const float3 centre = load3(leaf->centre);
  if (parallel) {
    const float area = 3.14159265f * leaf->radius * leaf->radius;
    e.ray.origin = centre + disc_point(towards, leaf->radius, v.x, v.y) + (OUTSIDE + leaf->radius) * towards;
    e.ray.direction = -towards;
    e.power = colour * (area * solid_angle * batch->share);
  } else {
    const float3 to = centre - origin;
    const float d2 = dot3(to, to), s2 = leaf->radius * leaf->radius / d2; /* from inside, or its middle: all round */
    const float3 axis = d2 > 0.0f ? to / sqrt(d2) : towards;
    e.ray.origin = origin;
    e.ray.direction = cone_direction(axis, s2 < 1.0f ? s2 : 1.0f, v, &solid_angle);
    e.power = colour * (solid_angle * batch->share);
  }
#endif
  if (batch->source == SOURCE_EMITTERS) {
    const float cosine = dot3(e.ray.direction, e.ends.origin_normal);
#ifdef EQUAL_POWER
    e.power = cosine > 0.0f ? e.power : (float3)(0.0f);
#else
    e.power *= fmax(cosine, 0.0f);
#endif
  }
  return e;
}
