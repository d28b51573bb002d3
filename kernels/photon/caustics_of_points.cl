/* What the photons of the map bring to the points of the pool, where they lie so wide apart that it changes little over a
 * disc: found once, for all views (method.md section 5).
 * NDRange: 1-D, a work-item a point, the first of them point `first`, padded; past point `count` they do nothing. */
#define GATHER_SURFACE
#include "photon/gather.cl"

/* Where the k nearest photons lie farther out than this many radii of the disc, what they bring is taken from the points
 * alone; where nearer than the other, found anew at every place that a ray meets. */
#define STORED_FROM 2.0f
#define STORED_ONLY 3.0f

/* caustics[i].w: share of the irradiance at point i that is taken from the points; caustics[i].xyz: that much of it, [W/m2,
 * scaled as RenderParams]. points[2 i]: position and radius of the disc, 0 for one that shows none; points[2 i + 1].xyz:
 * its unit normal. Splats with an area for power are the photons of the second map: power over area, weighted alike, has no
 * need of a surface that is flat, nor of one that goes on, as far as the photons lie. Where they lie farther out than
 * `farthest` radii, too many splats would have to be added up: there the picture gathers over a disc. */
__kernel OWN_VECTORS void caustics_of_points(const __global PhotonNode* nodes, const __global float* buckets,
                                 __constant GatherParams* params, const __global PhotonNode* area_nodes,
                                 const __global float* area_buckets, __constant GatherParams* area_params,
                                 const __global float4* points, __global float4* caustics, float farthest, uint first,
                                 uint count) {
  const uint i = first + get_global_id(0);
  if (i >= count)
    return;
  const float radius = points[2u * i].w;
  if (!(radius > 0.0f)) {
    caustics[i] = (float4)(0.0f);
    return;
  }
  const PhotonPool photons = {nodes, buckets}, areas = {area_nodes, area_buckets};
  const GatherPlace place = {points[2u * i].xyz, points[2u * i + 1u].xyz};
  const uint k = max(params->k, 2u); /* the farthest of them has no weight */
  NEAR_PHOTONS(near);
  nearest_photons(photons, params, place, k, INFINITY, INFINITY, &near);
  const bool enough = near.within + near.fresh >= k;
  const float bound2 = enough ? near.within2 : params->radius2, radii = sqrt(bound2) / radius;
  const float share = radii < farthest ? smoothstep(STORED_FROM, STORED_ONLY, radii) : 0.0f;
  float3 irradiance = (float3)(0.0f);
  if (share > 0.0f && near.count > 0u) {
    const float area = power_within(areas, area_params, place, bound2).x;
    if (area > 0.0f)
      irradiance = power_within(photons, params, place, bound2) / area;
  }
  caustics[i] = (float4)(share * irradiance, share);
}
