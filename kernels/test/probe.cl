/* Probes: what the device itself makes of shared structs and small functions. For tests. */
#include "traverse/octree_descent.cl"
#define WITH_PHONG 1
#define WITH_CONDUCTOR 1
#include "materials/conductor.cl"
#include "materials/media.cl"
#include "materials/phong.cl"
#include "lib/sampling.cl"
#include "shared/cone_types.h"
#include "shared/pair_types.h"
#include "shared/photon_types.h"
#include "shared/render_types.h"
#include "shared/traversal_types.h"

#define OFFSET(type, field) ((uint)(size_t) & (((__private type*)0)->field))

/* One work-item. sizes[...] = sizeof and offsets of the shared structs as the device lays them out. */
__kernel void probe_layout(__global uint* sizes) {
  sizes[0] = sizeof(OctreeNode);
  sizes[1] = OFFSET(OctreeNode, address);
  sizes[2] = OFFSET(OctreeNode, extra);
  sizes[3] = OFFSET(OctreeNode, count);
  sizes[4] = sizeof(OctreePoint);
  sizes[5] = OFFSET(OctreePoint, radius);
  sizes[6] = OFFSET(OctreePoint, normal);
  sizes[7] = OFFSET(OctreePoint, material);
  sizes[8] = OFFSET(OctreePoint, colour);
  sizes[9] = OFFSET(OctreePoint, area);
  sizes[10] = sizeof(Camera);
  sizes[11] = sizeof(RenderParams);
  sizes[12] = OFFSET(RenderParams, environment);
  sizes[13] = OFFSET(RenderParams, samples);
  sizes[14] = OFFSET(RenderParams, emitters);
  sizes[15] = OFFSET(RenderParams, step_delta);
  sizes[16] = sizeof(LightSource);
  sizes[17] = OFFSET(LightSource, strength);
  sizes[18] = OFFSET(LightSource, cumulative);
  sizes[19] = sizeof(Emitter);
  sizes[20] = sizeof(Material);
  sizes[21] = sizeof(RayQuery);
  sizes[22] = sizeof(RayAnswer);
  sizes[23] = sizeof(RayPacketQuery);
  sizes[24] = OFFSET(RayPacketQuery, t_max);
  sizes[25] = sizeof(RayPacketAnswer);
  sizes[26] = sizeof(EyeHits);
  sizes[27] = sizeof(SegmentQuery);
  sizes[28] = OFFSET(Material, type);
  sizes[29] = OFFSET(Material, specular);
  sizes[30] = OFFSET(Material, absorption);
  sizes[31] = OFFSET(Material, ior);
  sizes[32] = sizeof(Photon);
  sizes[33] = OFFSET(Photon, power);
  sizes[34] = sizeof(PhotonNode);
  sizes[35] = OFFSET(PhotonNode, high);
  sizes[36] = sizeof(PhotonLeaf);
  sizes[37] = OFFSET(PhotonLeaf, first);
  sizes[38] = sizeof(EmissionBatch);
  sizes[39] = OFFSET(EmissionBatch, share);
  sizes[40] = sizeof(PhotonFlight);
  sizes[41] = OFFSET(PhotonFlight, end);
  sizes[42] = OFFSET(PhotonFlight, absorbed);
  sizes[43] = sizeof(GatherParams);
  sizes[44] = OFFSET(GatherParams, radius2);
  sizes[45] = sizeof(ConeGrid);
  sizes[46] = OFFSET(ConeGrid, side_log2);
  sizes[47] = OFFSET(ConeGrid, first);
  sizes[48] = sizeof(Cone);
  sizes[49] = OFFSET(Cone, spread);
  sizes[50] = sizeof(VoxelShare);
  sizes[51] = sizeof(PairRows);
  sizes[52] = OFFSET(PairRows, points);
  sizes[53] = OFFSET(PairRows, step_delta);
  sizes[54] = sizeof(SenderRows);
  sizes[55] = OFFSET(SenderRows, receivers);
  sizes[56] = OFFSET(SenderRows, step_delta);
}

/* nodes[i] = the leaf or empty node that holds positions[i] (xyz), for i < count. */
__kernel void probe_descent(POOL_PARAMS, const __global float4* positions, __global uint4* nodes, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    nodes[i] = octree_descend(POOL_ARGS, positions[i].xyz);
}

/* values[i] = pcg4d(i, i, i, i) for i < count. */
__kernel void probe_rng(__global uint4* values, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    values[i] = pcg4d((uint4)(i));
}

/* bent[2 i] = (reflectance, cosine of the refracted ray, z of a ray refracted at the plane z = 0, z of one reflected there),
 * from glass[i] = (cosine of incidence, n_to / n_from, length, absorption); bent[2 i + 1].x = what the length leaves. */
__kernel void probe_glass(const __global float4* glass, __global float4* bent, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const float cosine = glass[i].x, eta = glass[i].y;
  const float3 n = (float3)(0.0f, 0.0f, 1.0f), direction = (float3)(sqrt(1.0f - cosine * cosine), 0.0f, -cosine);
  float cosine_t;
  const float reflectance = fresnel_dielectric(cosine, eta, &cosine_t);
  const float3 refracted = cosine_t > 0.0f ? refract3(direction, n, cosine, cosine_t, eta) : (float3)(0.0f);
  bent[2u * i] = (float4)(reflectance, cosine_t, refracted.z, reflect3(direction, n).z);
  bent[2u * i + 1u] = (float4)(beer((float3)(glass[i].w), glass[i].z), 0.0f);
}

/* lobe[i] = (cosine of a drawn direction with the mirrored one, its density times the weight over the cosine of a level
 * surface, the lobe there, its length) from drawn[i] = (u, v, exponent, z of the mirrored direction). */
__kernel void probe_phong(const __global float4* drawn, __global float4* lobe, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const float z = drawn[i].w, exponent = drawn[i].z;
  const float3 mirrored = (float3)(0.0f, sqrt(1.0f - z * z), z);
  const float3 d = phong_direction(mirrored, exponent, drawn[i].x, drawn[i].y);
  const float cosine = dot3(d, mirrored), density = (exponent + 1.0f) * 0.15915494f * pow(fmax(cosine, 0.0f), exponent);
  lobe[i] = (float4)(cosine, density * phong_weight(1.0f, exponent), phong_lobe(cosine, exponent), sqrt(dot3(d, d)));
}

/* reflectance[i] = share of light that metal reflects, from in[i] = (cosine of incidence, eta, extinction, unused). */
__kernel void probe_metal(const __global float4* in, __global float* reflectance, uint count) {
  const uint i = get_global_id(0);
  if (i < count)
    reflectance[i] = fresnel_conductor(in[i].x, in[i].y, in[i].z);
}

/* media[i] = what is left of NO_MEDIUM after steps[i], eight steps from the lowest byte on: 0 nothing, m enter material m, 128 + m
 * leave it. */
__kernel void probe_media(const __global ulong* steps, __global uint4* media, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  Media in = in_air();
  for (uint k = 0u; k < 8u; ++k) {
    const uint step = (uint)(steps[i] >> (8u * k)) & 255u;
    if (step != 0u)
      in = step < 128u ? within_medium(in, step) : without_medium(in, step - 128u);
  }
  media[i] = in;
}

/* places[samples * i + s] = place of sample s of pixel i, of a pixel's `samples`. */
__kernel void probe_places(__global float2* places, uint samples, uint seed, uint jitter, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  for (uint s = 0u; s < samples; ++s) {
    const SampleId id = {(uint2)(i % 64u, i / 64u), s, seed, 0u};
    places[samples * i + s] = place_in_pixel(id, samples, jitter != 0u);
  }
}

/* scalars[i] = cosine and sine of 2 pi turns[i]; lanes[32 k] on: of 16 k to 16 k + 15 as vectors, cosines and then sines. NDRange:
 * count / 16, whole. */
__kernel void probe_turn(const __global float* turns, __global float2* scalars, __global float* lanes) {
  const uint k = (uint)get_global_id(0);
  float16 cosines, sines;
  COSINE_SINE(float16, vload16(k, turns), cosines, sines);
  vstore16(cosines, 2u * k, lanes);
  vstore16(sines, 2u * k + 1u, lanes);
  for (uint i = 16u * k; i < 16u * k + 16u; ++i) {
    float c, s;
    COSINE_SINE(float, turns[i], c, s);
    scalars[i] = (float2)(c, s);
  }
}
