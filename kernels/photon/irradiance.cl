/* Irradiance of given places by the photons of the map (method.md section 5).
 * NDRange: 1-D, a work-item a place, padded; work-items past `count` do nothing. */
#define GATHER_SURFACE
#include "photon/gather.cl"

/* irradiance[i].xyz [W/m2, scaled as RenderParams] of the place points[2 i].xyz, of the side that points[2 i + 1].xyz, unit,
 * is the normal of. */
__kernel OWN_VECTORS void caustic_irradiance(const __global PhotonNode* nodes, const __global float* buckets,
                                 __constant GatherParams* params, const __global float4* points,
                                 __global float4* irradiance, uint count) {
  const uint i = get_global_id(0);
  if (i >= count)
    return;
  const PhotonPool pool = {nodes, buckets};
  const GatherPlace place = {points[2u * i].xyz, points[2u * i + 1u].xyz};
  NEAR_PHOTONS(near);
  nearest_photons(pool, params, place, params->k, INFINITY, INFINITY, &near);
  irradiance[i] = (float4)(irradiance_of(pool, params, params->k, &near), 0.0f);
}
