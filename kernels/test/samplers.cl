/* Probes of all that is drawn at random, each with the density that the kernels state for it. For tests (tests/stat). In every
 * kernel a work-item i < count draws once, by the numbers u[i] or those of pixel (i, 0). */
#include "photon/emit_from_surfaces.cl"
#include "render/eye_sample.cl"

/* drawn[i] = direction about axis.xyz. */
__kernel void probe_cosine(float4 axis, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    drawn[i] = (float4)(cosine_direction(axis.xyz, u[i].x, u[i].y), 0.0f);
}

/* drawn[i] = direction of the cone about axis.xyz with sine^2 axis.w, and its solid angle. */
__kernel void probe_cone(float4 axis, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  float solid_angle;
  const float3 direction = cone_direction(axis.xyz, axis.w, u[i].xy, &solid_angle);
  drawn[i] = (float4)(direction, solid_angle);
}

/* drawn[i] = point of the disc of radius axis.w across axis.xyz. */
__kernel void probe_disc(float4 axis, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    drawn[i] = (float4)(disc_point(axis.xyz, axis.w, u[i].x, u[i].y), 0.0f);
}

/* drawn[i] = direction about axis.xyz by a lobe of exponent axis.w, and the lobe's density there. */
__kernel void probe_phong_direction(float4 axis, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const float3 direction = phong_direction(axis.xyz, axis.w, u[i].x, u[i].y);
  drawn[i] = (float4)(direction, phong_density(dot3(direction, axis.xyz), axis.w));
}

static inline Surface plain_surface(float3 position, float3 normal, bool front) {
  Surface s;
  s.position = position;
  s.normal = normal;
  s.albedo = s.highlight = (float3)(0.0f);
  s.t = 1.0f;
  s.radius = 0.0f;
  s.splat = s.material = 0u;
  s.front = front;
  return s;
}

/* What material 0 makes of a ray of direction.xyz at a surface of normal.xyz, whose front it meets where normal.w > 0:
 * drawn[3 i] = (direction, whether the ray goes on), drawn[3 i + 1] = (weight, density), drawn[3 i + 2] = (f, density) there. */
__kernel void probe_scatter(const __global Material* materials, float4 normal, float4 direction, const __global float4* u,
                            __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Surface s = plain_surface((float3)(0.5f), normal.xyz, normal.w > 0.0f);
  Media media = s.front ? in_air() : within_medium(in_air(), 0u);
  Scatter scatter;
  const bool goes_on = scatter_ray(&s, materials, direction.xyz, u[i].xy, &media, &scatter);
  float pdf;
  const float3 f = eval_lobe(&s, materials, direction.xyz, scatter.direction, &pdf);
  drawn[3u * i] = (float4)(scatter.direction, goes_on ? 1.0f : 0.0f);
  drawn[3u * i + 1u] = (float4)(scatter.weight, scatter.pdf);
  drawn[3u * i + 2u] = (float4)(f, pdf);
}

/* A surface's samples of the emitting splats: drawn[3 i] = (direction, distance), drawn[3 i + 1] = (irradiance, density),
 * drawn[3 i + 2].x = density as a ray that meets the point has it, y = whether the light reaches the surface. */
__kernel void probe_emitter(POOL_PARAMS, const __global Material* materials, const __global Emitter* emitters, uint emitter_count,
                            float4 position, float4 normal, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Surface s = plain_surface(position.xyz, normal.xyz, true);
  LightSample sample;
  const bool faces = sample_emitter(POOL_ARGS, &s, materials, emitters, emitter_count, 0.0f, u[i], &sample);
  Surface met = plain_surface(position.xyz + sample.distance * sample.towards, sample.normal, true);
  const uint k = pick(&emitters->cumulative, sizeof(Emitter) / sizeof(float), emitter_count, u[i].x);
  met.material = (uint)pool_point_texel(POINT_TEXELS * emitters[k].point + 1u).w;
  met.t = sample.distance;
  drawn[3u * i] = (float4)(sample.towards, sample.distance);
  drawn[3u * i + 1u] = (float4)(sample.irradiance, sample.pdf);
  drawn[3u * i + 2u] = (float4)(emitter_pdf(&met, materials, sample.towards), faces ? 1.0f : 0.0f, 0.0f, 0.0f);
}

/* A surface's samples of many lights: drawn[2 i] = (direction, distance), drawn[2 i + 1] = (irradiance, density). */
__kernel void probe_delta_light(LIGHT_PARAMS, float4 position, float4 normal, const __global float4* u,
                                __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Lights lights = {LIGHT_ARGS};
  const Surface s = plain_surface(position.xyz, normal.xyz, true);
  LightSample sample;
  sample_light_source(&s, lights, u[i], 0u, &sample);
  drawn[2u * i] = (float4)(sample.towards, sample.distance);
  drawn[2u * i + 1u] = (float4)(sample.irradiance, sample.pdf);
}

/* A photon of each batch, its first: drawn[3 i] = its origin, drawn[3 i + 1] = its direction, drawn[3 i + 2] = its power. With
 * `looks` it looks for light from a specular splat. */
__kernel void probe_emission(POOL_PARAMS, LIGHT_PARAMS, const __global float4* radiance, const __global EmissionBatch* batches,
                             const __global PhotonLeaf* leaves, const __global uint* leaf_splats, uint looks,
                             __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const PhotonSource from = {{LIGHT_ARGS}, radiance, leaves, leaf_splats};
  const SampleId id = {(uint2)(i, 0x20000000u), 0u, params->seed, 0u};
  Emission e;
  if (looks != 0u)
    e = look_for_light(POOL_ARGS, from, batches + i, 0u, id);
  else
    e = emit_photon(POOL_ARGS, from, batches + i, 0u, id);
  drawn[3u * i] = (float4)(e.ray.origin, 0.0f);
  drawn[3u * i + 1u] = (float4)(e.ray.direction, 0.0f);
  drawn[3u * i + 2u] = (float4)(e.power, 0.0f);
}

/* drawn[i] = probability with which a ray goes on that factor.xyz is left of, after `bounces` bounces; 0 where it ends. */
__kernel void probe_roulette(float4 factor, float longest, uint bounces, uint seed, __global float* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const SampleId id = {(uint2)(i, 0u), 0u, seed, 0u};
  drawn[i] = russian_roulette(id, bounces, longest, factor.xyz);
}

/* drawn[samples i + s] = the numbers of sample s of pixel i for this use. */
__kernel void probe_stratified(uint dimension, uint vertex, uint samples, uint seed, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  for (uint s = 0u; s < samples; ++s) {
    const SampleId id = {(uint2)(i % 64u, i / 64u), s, seed, vertex};
    drawn[samples * i + s] = stratified4(id, dimension);
  }
}

/* drawn[i] = direction in which a surface of normal.xyz looks for an even environment, and its density as sampled minus that of
 * a ray in that direction. */
__kernel void probe_sky(LIGHT_PARAMS, float4 normal, const __global float4* u, __global float4* drawn, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const Lights lights = {LIGHT_ARGS};
  const Surface s = plain_surface((float3)(0.5f), normal.xyz, true);
  LightSample sample;
  sample_sky(&s, lights, u[i], 0u, &sample);
  const SkyLight met = sky_light(lights, sample.towards, sky_cosine_pdf(normal.xyz, sample.towards));
  drawn[i] = (float4)(sample.towards, sample.pdf - met.pdf);
}
