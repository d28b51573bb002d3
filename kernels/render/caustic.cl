/* Light that surfaces receive by way of mirrors and glass, gathered from the photon map (method.md section 5).
 *   HAS_CAUSTICS  defined where there are photons */
#include "traverse/traversal.cl"
#ifdef HAS_CAUSTICS
#define GATHER_SURFACE
#include "photon/gather.cl"

/* Shares of discs that all know their caustics add up to 1 but for rounding. */
#define ALL_STORED 0.9999f
#endif

/* Irradiance [W/m2, scaled] of the surface's front. */
static inline float3 caustic_irradiance_of(POOL_PARAMS, const Surface* s) {
#ifdef HAS_CAUSTICS
  if (s->caustic.w > ALL_STORED)
    return s->caustic.xyz;
  const PhotonPool pool = {photon_nodes, photon_buckets};
  const GatherPlace place = {s->position, s->normal};
  NEAR_PHOTONS(near);
  nearest_photons(pool, gather_params, place, gather_params->k, INFINITY, INFINITY, &near);
  return s->caustic.xyz + (1.0f - s->caustic.w) * irradiance_of(pool, gather_params, gather_params->k, &near);
#else
  return (float3)(0.0f);
#endif
}
