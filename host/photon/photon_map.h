#pragma once
/// The photon map: a kd-tree apart from the geometry, as kernels/photon/gather.cl walks it (method.md §5).
#include "octree/pool.h"
#include "octree/view.h"
#include "shared/photon_types.h"

namespace pointgi {

struct PhotonMap {
  Pool<PhotonNode> nodes;
  Pool<float> buckets; ///< PHOTON_BUCKET_WORDS a bucket
  unsigned levels = 0; ///< of nodes; 0 without photons
  std::size_t photons = 0;

  std::size_t bucket_count() const { return buckets.size() / PHOTON_BUCKET_WORDS; }
};

/// Sorts the photons into the map. The same photons in the same order give the same map, whatever the threads.
/// Throws std::invalid_argument where a position is not finite.
PhotonMap build_photon_map(View<Photon> photons);

/// A unit direction as Photon::inward has it, and back (to a five-hundredth).
pg_uint packed_direction(const float direction[3]);
void unpack_direction(pg_uint packed, float direction[3]);

} // namespace pointgi
