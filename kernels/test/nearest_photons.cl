/* The nearest photons of given places: for tests and measurements.
 * NDRange: 1-D, a work-item PHOTON_PLACES_AT_ONCE places in a row, which had better lie close together, padded; work-items
 * past `count` do nothing. */
#include "photon/gather.cl"

/* Neighbours' bounds seldom differ by more than this, but for those of few photons; where they do, the walk begins again. */
#define HOPED_GROWTH 1.2f
#define FEW_PHOTONS 16u

/* Of places[i].xyz the k = params->k nearest photons: distance2[k * i ...] and photon[k * i ...], the photon's number in the
 * order of the buckets, in no order; found[i] of them are written. k is at most GATHER_MOST. */
__kernel OWN_VECTORS void nearest_of_places(const __global PhotonNode* nodes, const __global float* buckets,
                                __constant GatherParams* params, const __global float4* places,
                                __global float* distance2, __global uint* photon, __global uint* found, uint count) {
  const PhotonPool pool = {nodes, buckets};
  const uint k = params->k, first = PHOTON_PLACES_AT_ONCE * get_global_id(0);
  NEAR_PHOTONS(near);
  float guess2 = INFINITY, hope2 = INFINITY;
  for (uint i = first; i < min(count, first + PHOTON_PLACES_AT_ONCE); ++i) {
    const GatherPlace place = {places[i].xyz, (float3)(0.0f)};
    if (i > first) {
      hope2 = k < FEW_PHOTONS ? INFINITY : HOPED_GROWTH * near.within2;
      guess2 = bound_from(near.within2, distance(place.position, places[i - 1u].xyz));
    }
    nearest_photons(pool, params, place, k, hope2, guess2, &near);
    const size_t to = (size_t)k * i;
    const bool too_many = near.within > k; /* equally far: the nearer ones, then those at the bound while there is room */
    uint kept = 0u;
    for (uint round = 0u; round < (too_many ? 2u : 1u); ++round)
      for (uint b = 0u; b < near.count; b += PHOTON_LANES) {
        const float16 d = vload16(0, near.distance2 + b);
        const int16 takes = !too_many ? d <= near.within2 : round == 0u ? d < near.within2 : d == near.within2;
        ulong left = byte_a_lane(takes.lo) | (byte_a_lane(takes.hi) << 1);
        for (; left != 0ul && kept < k; left &= left - 1ul) {
          const uint bit = (uint)popcount((left & (0ul - left)) - 1ul), at = b + (bit >> 3) + 8u * (bit & 1u);
          distance2[to + kept] = near.distance2[at];
          photon[to + kept] = near.photon[at];
          kept += 1u;
        }
      }
    found[i] = kept;
  }
}
